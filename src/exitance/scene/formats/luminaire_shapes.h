// SPDX-License-Identifier: Apache-2.0
// Area lamps of a lighting project, as polygons.
#pragma once

#include <cstdint>
#include <string>

#include "exitance/scene/scene.h"

namespace exitance {

/// Adds polygons of `surface` and returns their total area [m²]; corners are counter-clockwise seen
/// from where the light goes.

/// `aim` (unit) is where it faces; `height` runs along `up` made perpendicular to `aim`.
double add_rectangle(Scene& scene, std::uint32_t surface, const Vec3& centre, const Vec3& aim,
                     const Vec3& up, double width, double height);

/// A regular polygon of the area of the disc, π r²: a fan of triangles around the middle and a ring
/// of trapezoids around them.
double add_disc(Scene& scene, std::uint32_t surface, const Vec3& centre, const Vec3& aim,
                double radius);

/// Bands of latitude cut into planar trapezoids (triangles at the poles), facing outwards, of the
/// area of the sphere, 4 π r².
double add_sphere(Scene& scene, std::uint32_t surface, const Vec3& centre, double radius);

}  // namespace exitance
