// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/read_warnings.h"

#include <fmt/format.h>

namespace exitance {

namespace {

// Kinds may hold words of the file; a file of nothing but strange words must not fill memory.
constexpr std::size_t most_kinds = 10'000;

}  // namespace

void ReadWarnings::add(const std::string& kind, const Place& place, const std::string& what) {
    add(kind, place, what, false);
}

void ReadWarnings::note(const std::string& kind, const Place& place, const std::string& what) {
    add(kind, place, what, true);
}

void ReadWarnings::add(const std::string& kind, const Place& place, const std::string& what,
                       bool note) {
    if (seen(kind)) return;
    if (entries_.size() > most_kinds) return;
    const bool last = entries_.size() == most_kinds;
    index_.emplace(kind, entries_.size());
    entries_.push_back(
        {{place, last ? "there is more to warn of than can be listed" : what}, note && !last, 0});
}

bool ReadWarnings::seen(const std::string& kind) {
    const auto found = index_.find(kind);
    if (found == index_.end()) return false;
    ++entries_[found->second].more;
    return true;
}

void ReadWarnings::tell(Scene& scene) {
    for (Entry& entry : entries_) {
        if (entry.more > 0) entry.problem.what += fmt::format(" ({} more like it)", entry.more);
        (entry.note ? scene.notes : scene.warnings).push_back(std::move(entry.problem));
    }
    entries_.clear();
    index_.clear();
}

}  // namespace exitance
