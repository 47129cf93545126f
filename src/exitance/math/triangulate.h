// SPDX-License-Identifier: Apache-2.0
// Polygons of any number of corners as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

struct Triangulation {
    /// Corners as indices into the outline, each turning as the outline does. Parts without area
    /// are left out.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// False: the outline crosses itself, and the triangles do not cover exactly what it encloses.
    bool simple = true;
};

/// Cuts ears off (Meisters 1975, "Polygons have ears") in the plane of the outline's vector area.
/// Holes may be joined to the outline by seams that are walked in both directions. An outline
/// without area gives no triangles. Time grows with corners × concave corners.
Triangulation triangulate(std::span<const Vec3> outline);

/// Joins holes to an outline by seams, so that triangulate() can cut it: indices into the corners
/// of all loops, numbered one after the other. loops[0] is the outline, the others turn the other
/// way (loops that do not are turned round). A hole is joined at its corner farthest along the
/// widest axis, to the nearest corner that it sees (Eberly 2002, "Triangulation by ear clipping").
std::vector<std::uint32_t> join_holes(const std::vector<std::vector<Vec3>>& loops);

}  // namespace exitance
