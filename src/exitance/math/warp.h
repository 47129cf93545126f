// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square onto the domains that are sampled.
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "exitance/math/vector.h"

namespace exitance {

using UnitSquare = std::array<double, 2>;

/// Direction on the upper hemisphere (z up) with density cosθ/π (Malley's method).
inline Vec3 cosine_hemisphere(const UnitSquare& u) {
    const double r = std::sqrt(u[0]);
    const double phi = 2.0 * std::numbers::pi * u[1];
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0, 1.0 - u[0]))};
}

/// Barycentric weights of a point spread evenly over a triangle.
inline std::array<double, 3> uniform_triangle(const UnitSquare& u) {
    const double s = std::sqrt(u[0]);
    return {1.0 - s, s * (1.0 - u[1]), s * u[1]};
}

/// A point spread evenly over a triangle or a convex quadrilateral.
inline Vec3 uniform_polygon(std::span<const Vec3> corners, UnitSquare u) {
    if (corners.size() == 3) {
        const auto w = uniform_triangle(u);
        return corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
    }
    // Two triangles in proportion to their areas.
    const double first = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double second = length(cross(corners[2] - corners[0], corners[3] - corners[0]));
    const double share = first / (first + second);
    const bool in_first = u[0] < share;
    u[0] = in_first ? u[0] / share : (u[0] - share) / (1.0 - share);
    const auto w = uniform_triangle({std::min(u[0], 1.0 - 1e-12), u[1]});
    const Vec3 &b = in_first ? corners[1] : corners[2], &c = in_first ? corners[2] : corners[3];
    return corners[0] * w[0] + b * w[1] + c * w[2];
}

}  // namespace exitance
