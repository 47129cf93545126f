// SPDX-License-Identifier: Apache-2.0
// What stands between: closed convex bodies and flat convex sheets, merged from polygons so that
// there are as few of them as can be.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exitance/math/box.h"
#include "exitance/math/small_polygon.h"

namespace exitance {

/// A convex obstacle. An edge is part of the outline seen from x if one of its planes faces x and
/// the other does not; a sheet's edges always are.
struct Blocker {
    struct Edge {
        std::uint32_t from, to;  ///< corners, counter-clockwise around `left` seen from its front
        std::uint32_t left, right;  ///< planes
    };
    bool solid = false;
    /// Of a solid: its faces, outward. Of a sheet: its own plane, then one through each edge across
    /// it, outward.
    std::vector<Plane> planes;
    std::vector<Vec3> corners;
    std::vector<Edge> edges;
    Box bounds;

    std::size_t bytes() const {
        return sizeof(Blocker) + planes.capacity() * sizeof(Plane) +
               corners.capacity() * sizeof(Vec3) + edges.capacity() * sizeof(Edge);
    }
};

Blocker make_sheet(std::span<const Vec3> outline, const Plane& plane);

/// What blocks as all of `polygons` do, which are planar and convex and block both ways. Sheets
/// that have everything on one side are left out: they are in nothing's way. A polygon may be
/// listed twice, once for each side.
std::vector<Blocker> find_blockers(std::span<const std::span<const Vec3>> polygons);

/// The part of the blocker before the plane; none if nothing rises above it by more than `slack`.
std::optional<Blocker> cut(const Blocker& blocker, const Plane& plane, double slack);

/// Whether every straight line from one box to the other goes through the blocker. Exact: what a
/// convex body hides from a point is convex, so the corners decide.
bool hides(const Blocker& blocker, const Box& a, const Box& b);

}  // namespace exitance
