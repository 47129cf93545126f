// SPDX-License-Identifier: Apache-2.0
// The light that elements are drawn with at their corners: mostly what the corner receives, but
// where that lies under or behind something, it says nothing of the surface in front.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/solve/radiosity.h"

namespace exitance {

class CornerLight {
  public:
    /// Of the vertices of `leaves`. `unshot`, per vertex or empty, is one more number in each row.
    /// `radiosity` outlives this.
    CornerLight(const Radiosity& radiosity, std::span<const float> unshot,
                std::span<const ElementId> leaves);

    /// Numbers in a row.
    std::size_t stride() const { return stride_; }
    std::span<const float> operator[](VertexId v) const;

    /// Some corners of a leaf.
    struct Corners {
        std::array<VertexId, 4> at{};
        std::size_t count = 0;
        bool contains(VertexId v) const {
            return std::find(at.begin(), at.begin() + count, v) != at.begin() + count;
        }
    };
    /// The corners that are dark since something stands on the leaf between them and a bright one,
    /// if the middle is in front of that; `before` is the mean light of the others.
    Corners corners_behind(const Element& leaf, std::vector<float>& before) const;

  private:
    void append_column(std::span<const float> unshot);
    void fill_buried(std::span<const ElementId> leaves);
    void take_from_across(std::vector<char>& known);
    bool any_buried() const;

    const Radiosity& radiosity_;
    std::size_t stride_;
    std::vector<float> rows_;    ///< vertices × stride where rows have what is unshot
    std::vector<float> buried_;  ///< vertices × stride, or empty
};

}  // namespace exitance
