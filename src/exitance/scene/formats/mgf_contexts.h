// SPDX-License-Identifier: Apache-2.0
// The named contexts of MGF: colours, materials, vertices. One of each kind is current; entities
// change it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "exitance/math/vector.h"
#include "exitance/run/error.h"
#include "exitance/scene/cie_observer.h"

namespace exitance {

struct MgfColour {
    Xyz xyz{1, 1, 1};  ///< of luminance 1
};

/// Share of light and its colour, as taken from the current colour when it was given.
struct MgfShare {
    double value = 0;
    Xyz colour{1, 1, 1};

    friend bool operator==(const MgfShare&, const MgfShare&) = default;
};

struct MgfMaterial {
    bool two_sided = true;
    MgfShare rd, td, ed, rs, ts;
    double rs_roughness = 0, ts_roughness = 0;
    double refractive_index = 1;
    Place place{};            ///< of its definition
    std::uint64_t stamp = 0;  ///< a new one with every change
};

/// Do they say the same, wherever they were defined?
inline bool alike(const MgfMaterial& a, const MgfMaterial& b) {
    return a.two_sided == b.two_sided && a.rd == b.rd && a.td == b.td && a.ed == b.ed &&
           a.rs == b.rs && a.ts == b.ts && a.rs_roughness == b.rs_roughness &&
           a.ts_roughness == b.ts_roughness && a.refractive_index == b.refractive_index;
}

struct MgfVertex {
    Vec3 point, normal;
};

/// Contexts of one kind.
template <class T>
class MgfContexts {
  public:
    /// How a name is entered: the words after c, m or v.
    enum class Entry { unnamed, existing, fresh, copy, unknown, malformed };

    /// `name`, `name =`, `name = template`, or nothing. With Entry::unknown nothing is changed, and
    /// `missing()` is the name that has no context.
    Entry enter(std::span<const std::string_view> words) {
        if (words.empty()) {
            unnamed_ = T{};
            current_ = &unnamed_;
            name_.clear();
            return Entry::unnamed;
        }
        if (words.size() > 1 && words[1] != "=") return Entry::malformed;
        T* from = nullptr;
        if (words.size() != 2) {
            missing_ = words.size() == 1 ? words[0] : words[2];
            from = find(missing_);
            if (from == nullptr) return Entry::unknown;
        }
        if (words.size() == 1) {
            current_ = from;
        } else {
            const T value = from == nullptr ? T{} : *from;
            current_ = &named_.insert_or_assign(std::string(words[0]), value).first->second;
        }
        name_ = words[0];
        return words.size() == 1 ? Entry::existing : words.size() == 2 ? Entry::fresh : Entry::copy;
    }

    T* find(std::string_view name) {
        const auto found = named_.find(std::string(name));
        return found == named_.end() ? nullptr : &found->second;
    }
    T& current() { return *current_; }
    /// "" for the unnamed context.
    const std::string& name() const { return name_; }
    const std::string& missing() const { return missing_; }

    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& [name, value] : named_) out.push_back(name);
        return out;
    }

    MgfContexts() = default;
    MgfContexts(const MgfContexts&) = delete;  // current_ points into it
    MgfContexts& operator=(const MgfContexts&) = delete;

  private:
    std::unordered_map<std::string, T> named_;  // addresses stay
    T unnamed_;
    T* current_ = &unnamed_;
    std::string name_, missing_;
};

}  // namespace exitance
