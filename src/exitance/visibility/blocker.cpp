// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/blocker.h"

#include <algorithm>
#include <array>

namespace exitance {

Blocker make_sheet(std::span<const Vec3> outline, const Plane& plane) {
    Blocker sheet;
    sheet.corners.assign(outline.begin(), outline.end());
    sheet.planes.push_back(plane);
    const auto n = static_cast<std::uint32_t>(outline.size());
    for (std::uint32_t k = 0; k < n; ++k) {
        const Vec3 &a = outline[k], &b = outline[(k + 1) % n];
        const Vec3 outward = normalized(cross(b - a, plane.normal));
        sheet.planes.push_back({outward, dot(outward, a)});
        sheet.edges.push_back({k, (k + 1) % n, 0, k + 1});
        sheet.bounds.add(a);
    }
    return sheet;
}

namespace {

std::optional<Blocker> cut_sheet(const Blocker& sheet, std::span<const double> height) {
    std::vector<Vec3> kept;
    const std::size_t n = sheet.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        const Vec3 &a = sheet.corners[i], &b = sheet.corners[j];
        if (height[i] >= 0) kept.push_back(a);
        if ((height[i] > 0 && height[j] < 0) || (height[i] < 0 && height[j] > 0))
            kept.push_back(a + (b - a) * (height[i] / (height[i] - height[j])));
    }
    if (kept.size() < 3) return {};
    return make_sheet(kept, sheet.planes[0]);
}

/// Corners of the new face, which lies in the cutting plane; a face of the old body meets it in at
/// most two.
struct CutFace {
    std::array<std::uint32_t, 2> at{};
    std::uint32_t count = 0;
    bool lies_there = false;  ///< an old edge between them is in the plane already

    void add(std::uint32_t corner) {
        for (std::uint32_t k = 0; k < count; ++k)
            if (at[k] == corner) return;
        if (count < 2) at[count++] = corner;
    }
};

std::optional<Blocker> cut_solid(const Blocker& body, const Plane& plane,
                                 std::span<const double> height) {
    Blocker kept;
    kept.solid = true;
    kept.planes = body.planes;
    const auto cap = static_cast<std::uint32_t>(kept.planes.size());
    kept.planes.push_back(plane.flipped());

    std::vector<std::uint32_t> renamed(body.corners.size());
    for (std::size_t i = 0; i < body.corners.size(); ++i)
        if (height[i] >= 0) {
            renamed[i] = static_cast<std::uint32_t>(kept.corners.size());
            kept.corners.push_back(body.corners[i]);
        }
    std::vector<char> rises(body.planes.size(), 0);
    for (const Blocker::Edge& e : body.edges)
        if (height[e.from] > 0 || height[e.to] > 0) rises[e.left] = rises[e.right] = 1;
    std::vector<CutFace> meets(body.planes.size());
    for (const Blocker::Edge& e : body.edges) {
        const double a = height[e.from], b = height[e.to];
        if (a < 0 && b < 0) continue;
        Blocker::Edge edge{renamed[e.from], renamed[e.to], e.left, e.right};
        if (a == 0 && b == 0) {
            if (!rises[e.left] && !rises[e.right]) continue;
            if (!rises[e.left]) edge.left = cap;
            if (!rises[e.right]) edge.right = cap;
            meets[e.left].lies_there = meets[e.right].lies_there = true;
        } else if (a < 0 || b < 0) {
            if (a == 0 || b == 0) {  // only touches the plane from below
                const std::uint32_t corner = a == 0 ? edge.from : edge.to;
                meets[e.left].add(corner);
                meets[e.right].add(corner);
                continue;
            }
            const auto corner = static_cast<std::uint32_t>(kept.corners.size());
            const Vec3 &from = body.corners[e.from], &to = body.corners[e.to];
            kept.corners.push_back(from + (to - from) * (a / (a - b)));
            (a < 0 ? edge.from : edge.to) = corner;
            meets[e.left].add(corner);
            meets[e.right].add(corner);
        } else if (a == 0 || b == 0) {
            const std::uint32_t corner = a == 0 ? edge.from : edge.to;
            meets[e.left].add(corner);
            meets[e.right].add(corner);
        }
        kept.edges.push_back(edge);
    }
    for (std::uint32_t face = 0; face < cap; ++face) {
        if (meets[face].count < 2 || meets[face].lies_there || !rises[face]) continue;
        auto [from, to] = meets[face].at;
        // What is kept of the face lies to the left of its new edge.
        const Vec3 along = kept.corners[to] - kept.corners[from];
        if (dot(cross(kept.planes[face].normal, along), plane.normal) < 0) std::swap(from, to);
        kept.edges.push_back({from, to, face, cap});
    }
    for (const Vec3& c : kept.corners) kept.bounds.add(c);
    return kept;
}

}  // namespace

std::optional<Blocker> cut(const Blocker& blocker, const Plane& plane, double slack) {
    std::vector<double> height(blocker.corners.size());
    double lowest = 0, highest = 0;
    for (std::size_t i = 0; i < height.size(); ++i) {
        height[i] = plane.height(blocker.corners[i]);
        if (std::abs(height[i]) <= slack) height[i] = 0;
        lowest = std::min(lowest, height[i]);
        highest = std::max(highest, height[i]);
    }
    if (highest <= 0) return {};
    if (lowest >= 0) return blocker;
    return blocker.solid ? cut_solid(blocker, plane, height) : cut_sheet(blocker, height);
}

namespace {

Vec3 corner(const Box& box, unsigned which) {
    return {which & 1 ? box.upper.x : box.lower.x, which & 2 ? box.upper.y : box.lower.y,
            which & 4 ? box.upper.z : box.lower.z};
}

bool stops(const Blocker& blocker, const Vec3& from, const Vec3& to) {
    if (!blocker.solid) {
        const double a = blocker.planes[0].height(from), b = blocker.planes[0].height(to);
        if (!(a * b < 0)) return false;
        const Vec3 at = from + (to - from) * (a / (a - b));
        for (std::size_t k = 1; k < blocker.planes.size(); ++k)
            if (blocker.planes[k].height(at) > 0) return false;
        return true;
    }
    double enter = 0, leave = 1;
    for (const Plane& plane : blocker.planes) {
        const double a = plane.height(from), b = plane.height(to);
        if (a > 0 && b > 0) return false;
        if (a > 0) enter = std::max(enter, a / (a - b));
        if (b > 0) leave = std::min(leave, a / (a - b));
        if (enter >= leave) return false;
    }
    return true;
}

}  // namespace

bool hides(const Blocker& blocker, const Box& a, const Box& b) {
    if (!stops(blocker, a.centre(), b.centre())) return false;
    for (unsigned i = 0; i < 8; ++i)
        for (unsigned j = 0; j < 8; ++j)
            if (!stops(blocker, corner(a, i), corner(b, j))) return false;
    return true;
}

}  // namespace exitance
