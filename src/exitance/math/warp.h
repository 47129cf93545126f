// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square onto the domains that are sampled.
#pragma once

#include <array>
#include <numbers>

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

}  // namespace exitance
