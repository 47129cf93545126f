// SPDX-License-Identifier: Apache-2.0
// Spheres, cones, rings and tori as facets whose corners lie on the true surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/scene/scene.h"

namespace exitance {

struct Facets {
    std::vector<Vec3> points;
    std::vector<Vec3> normals;  ///< parallel to `points`: unit, of the true surface; zero = facet's
    std::vector<std::array<std::uint32_t, 4>> polygons;  ///< as Polygon::corners
    double true_area = 0;                                ///< of the surface they stand for [m²]

    double area() const;
    /// Front becomes back.
    void turn_round();
};

/// Facets of a full turn so that none lies deeper than `tolerance` radii inside its circle:
/// 1 − cos(π/n) ≤ tolerance; a multiple of 4, at least 8.
std::uint32_t facets_per_turn(double tolerance);

/// Facing outward: `facets` around, facets/2 from pole to pole.
Facets sphere_facets(const Vec3& centre, double radius, std::uint32_t facets);
std::uint64_t sphere_facet_count(std::uint32_t facets);

/// Side of a cylinder or a frustum of a cone between two discs, without ends, facing outward; one
/// of the radii may be 0. Corners of two that share a disc are the same.
Facets frustum_facets(const Vec3& from, double from_radius, const Vec3& to, double to_radius,
                      std::uint32_t facets);

/// A disc (inner = 0) or ring facing along `normal`, its rim where a frustum's is.
Facets ring_facets(const Vec3& centre, const Vec3& normal, double inner, double outer,
                   std::uint32_t facets);

/// A torus around `axis` between two radii, facing outward.
Facets torus_facets(const Vec3& centre, const Vec3& axis, double inner, double outer,
                    std::uint32_t facets);

}  // namespace exitance
