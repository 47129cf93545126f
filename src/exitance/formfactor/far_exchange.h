// SPDX-License-Identifier: Apache-2.0
// Exchange areas of one facet with sixteen far ones at a time, nothing between: two by two points
// on either, and how far and before what planes they are.
#pragma once

#include <array>
#include <span>

#include "exitance/formfactor/enclosure.h"
#include "exitance/math/small_polygon.h"
#include "exitance/visibility/polygon_block.h"

namespace exitance {

/// A facet with its Gauss points; the weights sum to its area.
struct SampledFacet {
    std::array<Vec3, 4> corners;  ///< a triangle repeats its last
    std::uint32_t count = 0;
    Plane plane;
    double area = 0, radius = 0;
    Vec3 centre;
    std::array<Vec3, 4> points;
    std::array<double, 4> weights;

    SampledFacet() = default;
    explicit SampledFacet(std::span<const Vec3> outline);
    std::span<const Vec3> outline() const { return {corners.data(), count}; }
};

struct alignas(64) SampledBlock {
    using Lanes = PolygonBlock::Lanes;
    PolygonBlock outlines;
    std::array<Lanes, 4> x, y, z, weight;
    Lanes cx, cy, cz, radius;

    void set(std::size_t lane, const SampledFacet& facet);
};

struct alignas(64) FarExchange {
    PolygonBlock::Lanes area;      ///< exchange area, by the points
    PolygonBlock::Lanes distance;  ///< between the centres, in sums of the radii
    LaneMask faces = 0;            ///< some of each is before some of the other
    LaneMask wholly = 0;           ///< all of each is before all of the other
};

void far_exchange(const SampledFacet& facet, const SampledBlock& block, float slack,
                  FarExchange& exchange);

}  // namespace exitance
