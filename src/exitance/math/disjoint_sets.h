// SPDX-License-Identifier: Apache-2.0
// Numbers 0 … n − 1 in sets that are joined (union–find, with path halving).
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace exitance {

class DisjointSets {
  public:
    explicit DisjointSets(std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    /// The smallest member of the set that i is in, whatever the order of the joins.
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    /// The sets, in the order of their smallest members; members ascend.
    std::vector<std::vector<std::uint32_t>> members() {
        std::vector<std::vector<std::uint32_t>> found(parent_.size());
        for (std::uint32_t i = 0; i < parent_.size(); ++i) found[find(i)].push_back(i);
        std::erase_if(found, [](const auto& set) { return set.empty(); });
        return found;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace exitance
