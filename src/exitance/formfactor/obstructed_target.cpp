// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/obstructed_view.h"

namespace exitance {

namespace {

// Lines that come closer than this share of the pair's size are one.
constexpr double one_line = 1e-6;

ObstructedTarget::FloatPlane rounded(const Plane& plane) {
    return {Vec3f(plane.normal), static_cast<float>(plane.offset)};
}

ObstructedTarget::Line line(const Vec3& a, const Vec3& b) {
    const double l = length(b - a);
    return {Vec3f(a), Vec3f(l > 0 ? (b - a) / l : Vec3{}), static_cast<float>(l)};
}

struct Ends {
    Vec3 from, to;
};

/// `left`, `right`: planes through `b`.
ObstructedTarget::Alike alike(const Ends& a, const Ends& b, const Plane& left, const Plane& right) {
    for (const Vec3& p : {a.from, a.to})
        if (std::abs(left.height(p)) > one_line || std::abs(right.height(p)) > one_line)
            return ObstructedTarget::Alike::no;
    const Vec3 along = normalized(b.to - b.from);
    for (const Vec3& p : {a.from, a.to})
        if (length(cross(p - b.from, along)) > one_line) return ObstructedTarget::Alike::no;
    return dot(a.to - a.from, along) > 0 ? ObstructedTarget::Alike::same_way
                                         : ObstructedTarget::Alike::opposite;
}

}  // namespace

void ObstructedTarget::set(const SmallPolygon& target, const Plane& target_plane,
                           const Vec3& receiver_normal, std::span<const Obstacle> obstacles,
                           const Vec3& origin, double scale) {
    origin_ = origin;
    scale_ = scale;
    const auto place = [&](const Vec3& p) { return (p - origin) * scale; };
    const auto moved = [&](const Plane& p) { return Plane{p.normal, p.height(origin) * -scale}; };
    const Plane facing = moved(target_plane);
    plane = rounded(facing);
    receiver = Vec3f(receiver_normal);

    const std::size_t n = target.count;
    std::array<Vec3, SmallPolygon::capacity> corner;
    std::array<Plane, SmallPolygon::capacity> outward;
    for (std::size_t c = 0; c < n; ++c) corner[c] = place(target.at[c]);
    sides.resize(n);
    for (std::size_t c = 0; c < n; ++c) {
        const Vec3 &a = corner[c], &b = corner[(c + 1) % n];
        const Vec3 normal = normalized(cross(b - a, facing.normal));
        outward[c] = {normal, dot(normal, a)};
        sides[c] = {line(a, b), rounded(outward[c])};
    }

    rims.clear();
    first_rim.clear();
    rim_over_plane.clear();
    corner_over_rim.clear();
    side_on_rim.clear();
    rim_over_side.clear();
    struct Exact {
        Ends ends;
        Plane left, right;
    };
    std::vector<Exact> exact;
    for (std::uint32_t k = 0; k < obstacles.size(); ++k) {
        first_rim.push_back(static_cast<std::uint32_t>(rims.size()));
        const Blocker& b = *obstacles[k].blocker;
        for (const std::uint32_t which : obstacles[k].rims) {
            const Blocker::Edge& edge = b.edges[which];
            const Exact e{{place(b.corners[edge.from]), place(b.corners[edge.to])},
                          moved(b.planes[edge.left]),
                          moved(b.planes[edge.right])};
            exact.push_back(e);
            rims.push_back(
                {line(e.ends.from, e.ends.to), rounded(e.left), rounded(e.right), k, !b.solid});
            rim_over_plane.push_back({static_cast<float>(facing.height(e.ends.from)),
                                      static_cast<float>(facing.height(e.ends.to))});
            for (std::size_t c = 0; c < n; ++c) {
                corner_over_rim.push_back({static_cast<float>(e.left.height(corner[c])),
                                           static_cast<float>(e.right.height(corner[c]))});
                rim_over_side.push_back({static_cast<float>(outward[c].height(e.ends.from)),
                                         static_cast<float>(outward[c].height(e.ends.to))});
                side_on_rim.push_back(
                    alike({corner[c], corner[(c + 1) % n]}, e.ends, e.left, e.right));
            }
        }
    }
    first_rim.push_back(static_cast<std::uint32_t>(rims.size()));

    const std::size_t count = rims.size();
    rim_over_rim.assign(obstacles.size() > 1 ? count * count : 0, {});
    rim_on_rim.assign(rim_over_rim.size(), Alike::no);
    if (obstacles.size() < 2) return;
    for (std::size_t r = 0; r < count; ++r)
        for (std::size_t q = 0; q < count; ++q) {
            if (rims[r].obstacle == rims[q].obstacle) continue;
            const Exact &of = exact[r], &over = exact[q];
            const auto heights = [&](const Vec3& p) {
                return Heights{static_cast<float>(over.left.height(p)),
                               static_cast<float>(over.right.height(p))};
            };
            rim_over_rim[r * count + q] = {heights(of.ends.from), heights(of.ends.to)};
            rim_on_rim[r * count + q] = alike(of.ends, over.ends, over.left, over.right);
        }
}

}  // namespace exitance
