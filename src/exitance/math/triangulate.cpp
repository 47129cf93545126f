// SPDX-License-Identifier: Apache-2.0
#include "exitance/math/triangulate.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"

namespace exitance {

namespace {

struct Point {
    double x = 0, y = 0;

    friend bool operator==(const Point&, const Point&) = default;
};

// Twice the area of a, b, c: positive if they turn left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<Point> flattened(std::span<const Vec3> corners, const Vec3& normal) {
    const Frame frame(normal);
    std::vector<Point> out;
    out.reserve(corners.size());
    for (const Vec3& c : corners) {
        const Vec3 v = c - corners[0];
        out.push_back({dot(v, frame.tangent), dot(v, frame.bitangent)});
    }
    return out;
}

// An outline that has no ears this often crosses itself all over; looking for more takes long.
constexpr std::size_t most_forced = 16;

// The corners that are left, as a ring.
class Ring {
  public:
    explicit Ring(const std::vector<Point>& points)
        : points_(points), next_(points.size()), previous_(points.size()), left_(points.size()) {
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            next_[i] = (i + 1) % static_cast<std::uint32_t>(points.size());
            previous_[next_[i]] = i;
        }
        double extent = 0;
        for (const Point& p : points) extent = std::max({extent, std::abs(p.x), std::abs(p.y)});
        flat_ = 1e-12 * extent * extent;
        for (std::uint32_t i = 0; i < points.size(); ++i)
            if (turn_at(i) < 0) concave_.push_back(i);
    }

    std::size_t left() const { return left_; }
    std::uint32_t next(std::uint32_t i) const { return next_[i]; }
    std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }
    double turn_at(std::uint32_t i) const {
        return turn(points_[previous_[i]], points_[i], points_[next_[i]]);
    }
    bool is_flat(std::uint32_t i) const { return std::abs(turn_at(i)) <= flat_; }
    /// A spike: the outline comes back the way it went.
    bool is_spike(std::uint32_t i) const {
        const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        return is_flat(i) && (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) >= 0;
    }

    /// Turns left, and no corner that turns right lies in it. Corners at the places of its own
    /// corners (ends of seams) do not count, unless the outline enters the ear there.
    bool is_ear(std::uint32_t i) const {
        const std::uint32_t before = previous_[i], after = next_[i];
        const Point &a = points_[before], &b = points_[i], &c = points_[after];
        if (turn(a, b, c) <= flat_) return false;
        const auto [left, right] = std::minmax({a.x, b.x, c.x});
        const auto [below, above] = std::minmax({a.y, b.y, c.y});
        for (const std::uint32_t k : concave_) {
            const Point& p = points_[k];
            if (p.x < left || p.x > right || p.y < below || p.y > above) continue;
            if (k == before || k == i || k == after || next_[k] == k) continue;
            if (p == a || p == b || p == c) {
                if (enters(k, a, b, c)) return false;
                continue;
            }
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    void remove(std::uint32_t i) {
        const std::uint32_t before = previous_[i], after = next_[i];
        next_[before] = after;
        previous_[after] = before;
        next_[i] = i;  // marks it as gone
        --left_;
        if (++gone_ * 2 > concave_.size() + 16) {
            std::erase_if(concave_,
                          [&](std::uint32_t k) { return next_[k] == k || turn_at(k) > 0; });
            gone_ = 0;
        }
    }

  private:
    static bool strictly_inside(const Point& p, const Point& a, const Point& b, const Point& c) {
        return turn(a, b, p) > 0 && turn(b, c, p) > 0 && turn(c, a, p) > 0;
    }
    // Does an edge at corner k, which lies at a corner of the triangle, lead into the triangle?
    bool enters(std::uint32_t k, const Point& a, const Point& b, const Point& c) const {
        const Point& p = points_[k];
        for (const std::uint32_t other : {previous_[k], next_[k]}) {
            const Point& q = points_[other];
            if (q == a || q == b || q == c) continue;
            // A short way along the edge; exact in direction, the length does not matter.
            const Point step{p.x + (q.x - p.x) * 1e-6, p.y + (q.y - p.y) * 1e-6};
            if (strictly_inside(step, a, b, c)) return true;
        }
        return false;
    }

    const std::vector<Point>& points_;
    std::vector<std::uint32_t> next_, previous_, concave_;
    std::size_t left_, gone_ = 0;
    double flat_ = 0;
};

}  // namespace

Triangulation triangulate(std::span<const Vec3> outline) {
    Triangulation out;
    const Vec3 normal = unit_normal(outline);
    if (outline.size() < 3 || normal == Vec3{}) return out;
    const std::vector<Point> points = flattened(outline, normal);
    Ring ring(points);
    const auto cut = [&](std::uint32_t i) {
        out.triangles.push_back({ring.previous(i), i, ring.next(i)});
        ring.remove(i);
    };
    std::uint32_t at = 0;
    std::size_t looked_at = 0;  // corners in a row that are no ears
    std::size_t forced = 0;     // cuts that were none
    while (ring.left() > 3) {
        const std::uint32_t next = ring.next(at);
        if (ring.is_spike(at)) {
            ring.remove(at);
            looked_at = 0;
        } else if (forced > most_forced ? ring.turn_at(at) > 0 : ring.is_ear(at)) {
            cut(at);
            looked_at = 0;
        } else if (++looked_at > ring.left()) {
            // No ears: rounding, or the outline crosses itself. Give up the flattest corner, else
            // cut the first that turns left, so that it ends.
            std::uint32_t chosen = at;
            bool flat = false, left = false;
            for (std::size_t n = 0; n < ring.left() && !flat; ++n, at = ring.next(at)) {
                flat = ring.is_flat(at);
                if (flat || (!left && ring.turn_at(at) > 0)) chosen = at;
                left |= ring.turn_at(at) > 0;
            }
            const std::uint32_t after = ring.next(chosen);
            if (flat) {
                ring.remove(chosen);
            } else {
                out.simple = false;
                ++forced;
                cut(chosen);
            }
            at = after;
            looked_at = 0;
            continue;
        }
        at = next;
    }
    if (!ring.is_flat(at)) {
        out.simple = out.simple && ring.turn_at(at) > 0;
        out.triangles.push_back({ring.previous(at), at, ring.next(at)});
    }
    return out;
}

std::vector<std::uint32_t> join_holes(const std::vector<std::vector<Vec3>>& loops) {
    std::vector<Vec3> corners;
    std::vector<std::vector<std::uint32_t>> rings;
    for (const auto& loop : loops) {
        std::vector<std::uint32_t>& ring = rings.emplace_back(loop.size());
        std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(corners.size()));
        corners.insert(corners.end(), loop.begin(), loop.end());
    }
    const Vec3 normal = unit_normal(loops[0]);
    const std::vector<Point> points = flattened(corners, normal);
    for (std::size_t h = 1; h < loops.size(); ++h)
        if (dot(vector_area(loops[h]), normal) > 0) std::reverse(rings[h].begin(), rings[h].end());

    // Holes from the right: a seam to the right meets only what has been joined already.
    const auto rightmost = [&](std::vector<std::uint32_t>& ring) {
        return std::max_element(ring.begin(), ring.end(), [&](std::uint32_t a, std::uint32_t b) {
            return points[a].x < points[b].x;
        });
    };
    std::vector<std::vector<std::uint32_t>> holes;
    for (std::size_t h = 1; h < rings.size(); ++h) {
        if (rings[h].empty()) continue;
        std::rotate(rings[h].begin(), rightmost(rings[h]), rings[h].end());
        holes.push_back(std::move(rings[h]));
    }
    std::stable_sort(holes.begin(), holes.end(),
                     [&](const auto& a, const auto& b) { return points[a[0]].x > points[b[0]].x; });

    std::vector<std::uint32_t> joined = rings[0];
    for (const auto& hole : holes) {
        const Point& from = points[hole[0]];
        const auto crosses = [&](const Point& to, const Point& a, const Point& b) {
            if (a == from || a == to || b == from || b == to) return false;
            const double s = turn(from, to, a), t = turn(from, to, b);
            const double u = turn(a, b, from), v = turn(a, b, to);
            return (s > 0) != (t > 0) && (u > 0) != (v > 0);
        };
        // Inside the corner's angle: seams must leave into the polygon.
        const auto inside_angle = [&](std::size_t i) {
            const std::size_t n = joined.size();
            const Point &a = points[joined[(i + n - 1) % n]], &b = points[joined[i]],
                        &c = points[joined[(i + 1) % n]];
            const bool left_of_first = turn(a, b, from) > 0, left_of_second = turn(b, c, from) > 0;
            return turn(a, b, c) >= 0 ? left_of_first && left_of_second
                                      : left_of_first || left_of_second;
        };
        std::size_t best = joined.size(), nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        double least_of_all = least;
        for (std::size_t i = 0; i < joined.size(); ++i) {
            const Point& to = points[joined[i]];
            const double distance = std::hypot(to.x - from.x, to.y - from.y);
            if (distance < least_of_all) least_of_all = distance, nearest = i;
            if (distance >= least || !inside_angle(i)) continue;
            bool free = true;
            for (std::size_t k = 0; k < joined.size() && free; ++k)
                free = !crosses(to, points[joined[k]], points[joined[(k + 1) % joined.size()]]);
            for (std::size_t k = 0; k < hole.size() && free; ++k)
                free = !crosses(to, points[hole[k]], points[hole[(k + 1) % hole.size()]]);
            if (free) least = distance, best = i;
        }
        if (best == joined.size()) best = nearest;  // nothing is in sight: loops cross
        std::vector<std::uint32_t> seam(hole.begin(), hole.end());
        seam.push_back(hole[0]);
        seam.push_back(joined[best]);
        joined.insert(joined.begin() + static_cast<std::ptrdiff_t>(best) + 1, seam.begin(),
                      seam.end());
    }
    return joined;
}

}  // namespace exitance
