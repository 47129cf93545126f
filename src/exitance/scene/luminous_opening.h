// SPDX-License-Identifier: Apache-2.0
// Where a luminaire shines from: the shape of its luminous opening, which makes its near-field
// light and the softness of its shadows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

/// A body around the photometric centre, in the photometric frame: x along C0, y along C90, z up
/// (away from γ = 0). Sizes may be zero: a box without height is a rectangle, a cylinder without
/// height a disc, a box of one length a line.
struct LuminousOpening {
    enum class Shape {
        point,
        box,
        cylinder,  ///< with elliptical ends, along `axis`
        ellipsoid
    };
    Shape shape = Shape::point;
    Vec3 size{};             ///< whole extents along x, y, z [m]
    std::uint32_t axis = 2;  ///< of a cylinder: 0 = x, 1 = y, 2 = z
    /// False: of a cylinder only the ends shine, and each side of a box as high as `sides` says.
    bool sides_shine = true;
    std::array<double, 4> sides{};  ///< heights from the bottom, to C0, C90, C180, C270 [m]

    /// Length of the diagonal [m]; 0 for a point.
    double extent() const { return shape == Shape::point ? 0 : length(size); }
};

/// A flat part of the opening that shines to its front.
struct OpeningFacet {
    std::array<Vec3, 4> corners;  ///< counter-clockwise seen from outside
    std::uint32_t count = 4;
    Vec3 normal;  ///< unit, outwards
    double area = 0;
};

/// The surface of an opening as planar facets, which face every direction that light can take; none
/// for a point or a line. Curved sides become 16 facets round the axis.
std::vector<OpeningFacet> facets(const LuminousOpening& opening);

}  // namespace exitance
