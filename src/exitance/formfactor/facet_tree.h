// SPDX-License-Identifier: Apache-2.0
// Facets in spatial order: a hierarchy whose leaves are blocks of sixteen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exitance/formfactor/far_exchange.h"
#include "exitance/math/box.h"

namespace exitance {

/// Where a set of facets is: their bounds, and their plane if they share one.
struct FacetExtent {
    Box box;
    std::optional<Plane> plane;

    FacetExtent() = default;
    FacetExtent(std::span<const SampledFacet> facets, std::span<const std::uint32_t> which,
                double slack);
    /// Whether nothing of the other set is before this plane.
    bool turns_away_from(const FacetExtent& other, double slack) const;
};

class FacetTree {
  public:
    struct Block {
        SampledBlock lanes;
        std::array<std::uint32_t, PolygonBlock::capacity> facet{};
    };
    struct Node {
        FacetExtent extent;
        std::uint32_t least_row = 0;
        std::uint32_t right = 0;  ///< the left child follows its parent; 0 = leaf
        std::uint32_t block = 0;
    };

    /// `rows`: of each facet.
    FacetTree(std::span<const SampledFacet> facets, std::span<const std::uint32_t> rows,
              double slack);

    std::vector<Node> nodes;  ///< the first is the root
    std::vector<Block> blocks;

  private:
    void build(std::span<std::uint32_t> which, std::span<const SampledFacet> facets,
               std::span<const std::uint32_t> rows, double slack);
};

/// Key by which facets that face alike and lie near each other come near each other; positions in
/// a box of unit size around the origin.
std::uint64_t spatial_key(const SampledFacet& facet);

}  // namespace exitance
