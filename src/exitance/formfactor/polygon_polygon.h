// SPDX-License-Identifier: Apache-2.0
// Exchange area of two polygons that see each other freely, exact: the double contour integral
// (Moon 1936; Sparrow 1963) with its inner line integral in closed form.
#pragma once

#include <span>

#include "exitance/math/vector.h"

namespace exitance {

/// A_a F_ab = A_b F_ba [square of the corners' unit] between the fronts of two convex planar
/// polygons of up to eight corners, counter-clockwise seen from the front, nothing between them.
/// They may share edges or corners and cut each other's planes; what lies behind the other's plane
/// is left out. `tolerance`: error relative to the smaller area, about; 1e-13 is reached.
double exchange_area(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance = 1e-10);

}  // namespace exitance
