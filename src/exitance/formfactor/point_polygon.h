// SPDX-License-Identifier: Apache-2.0
// Form factor from a differential area to a polygon, exact: Lambert's formula (Photometria, 1760;
// as in Baum, Rushmeier & Winget 1989, eq. 6).
#pragma once

#include <span>

#include "exitance/math/vector.h"

namespace exitance {

/// Irradiance at `point` with unit `normal` from a polygon of unit exitance, unobstructed: the
/// fraction of what leaves the point that reaches the polygon's front [0 … 1]. The part of the
/// polygon below the receiver's horizon is cut off; from behind the polygon the factor is 0.
/// `corners`: convex, planar, counter-clockwise seen from the front.
double point_polygon_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners);

}  // namespace exitance
