// SPDX-License-Identifier: Apache-2.0
// Warnings and notes of a reader: one per kind of thing, at its first place, with how often it came
// up.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

class ReadWarnings {
  public:
    /// Notes `what` at `place`. Of those with the same `kind` only the first is shown, and the
    /// others are counted.
    void add(const std::string& kind, const Place& place, const std::string& what);
    /// The same for what is not wrong with the file but good to know.
    void note(const std::string& kind, const Place& place, const std::string& what);
    /// Has this kind come up before? Then `place` and `what` need not be put together.
    bool seen(const std::string& kind);
    /// Moves all to the scene's warnings and notes, in the order in which they came up first.
    void tell(Scene& scene);

  private:
    void add(const std::string& kind, const Place& place, const std::string& what, bool note);

    struct Entry {
        Problem problem;
        bool note = false;
        std::size_t more = 0;
    };
    std::vector<Entry> entries_;
    std::unordered_map<std::string, std::size_t> index_;
};

}  // namespace exitance
