// SPDX-License-Identifier: Apache-2.0
// The inner loop of obstructed_view.h; included by instruction_sets.h.

using Target = ObstructedTarget;
using Alike = Target::Alike;

struct Point {
    Wide x, y, z;
};

EXITANCE_WIDE_INLINE Wide height(const Target::FloatPlane& plane, const Point& p) {
    return p.x * plane.normal.x + p.y * plane.normal.y + p.z * plane.normal.z - plane.offset;
}

/// A line as a point sees it: the angle between two places on it, times the part of the receiver's
/// normal across the plane through point and line.
struct SeenLine {
    Wide weight, distance, distance2, foot;
    float length;

    EXITANCE_WIDE_INLINE SeenLine(const Target::Line& line, const Point& p, const Vec3f& n)
        : length(line.length) {
        const Wide ax = line.from.x - p.x, ay = line.from.y - p.y, az = line.from.z - p.z;
        const Vec3f& d = line.along;
        const Wide cx = ay * d.z - az * d.y, cy = az * d.x - ax * d.z, cz = ax * d.y - ay * d.x;
        distance2 = cx * cx + cy * cy + cz * cz + 1e-20f;
        const Wide inverse = reciprocal_root(distance2);
        distance = distance2 * inverse;
        weight = (cx * n.x + cy * n.y + cz * n.z) * inverse;
        foot = ax * d.x + ay * d.y + az * d.z;
    }
    /// Between the shares `from` < `to` of the line.
    EXITANCE_WIDE_INLINE Wide angle(const Wide& from, const Wide& to) const {
        const Wide a = foot + from * length, b = foot + to * length;
        return angle_of(distance * (b - a), distance2 + a * b);
    }
};

struct Interval {
    Wide from, to;

    /// Keeps where a quantity that is linear along the line and `a`, `b` at its ends is ≤ 0.
    EXITANCE_WIDE_INLINE void keep_below(const Wide& a, const Wide& b) {
        const Wide t = a / (a - b);
        const Wide begin = wide_max(from, b > 0.0f ? wide(2) : t);
        from = a > 0.0f ? begin : from;
        to = (a <= 0.0f) & (b > 0.0f) ? wide_min(to, t) : to;
    }
    EXITANCE_WIDE_INLINE void drop() { from = wide(2); }
};

// The union of intervals of one line, per lane; `parts` has room for one of each obstacle.
struct Covered {
    float* parts;
    std::size_t count = 0;

    EXITANCE_WIDE_INLINE Interval at(std::size_t k) const {
        return {load(parts + 2 * k * EXITANCE_LANES), load(parts + (2 * k + 1) * EXITANCE_LANES)};
    }
    EXITANCE_WIDE_INLINE void set(std::size_t k, const Interval& part) {
        store(parts + 2 * k * EXITANCE_LANES, part.from);
        store(parts + (2 * k + 1) * EXITANCE_LANES, part.to);
    }
    EXITANCE_WIDE_INLINE void add(const Interval& part) {
        const WideMask real = part.from < part.to;
        if (!any(real)) return;
        set(count++, {real ? part.from : wide(0), real ? part.to : wide(0)});
    }
    EXITANCE_WIDE_INLINE Wide angle(const SeenLine& line) {
        for (std::size_t last = count; last > 1; --last)  // sort by where they begin
            for (std::size_t k = 0; k + 1 < last; ++k) {
                const Interval a = at(k), b = at(k + 1);
                const WideMask swap = b.from < a.from;
                set(k, {swap ? b.from : a.from, swap ? b.to : a.to});
                set(k + 1, {swap ? a.from : b.from, swap ? a.to : b.to});
            }
        Wide sum = wide(0), reach = wide(0);
        for (std::size_t k = 0; k < count; ++k) {
            const Interval part = at(k);
            const Wide from = wide_max(part.from, reach), to = wide_max(part.to, from);
            sum += line.angle(from, to);
            reach = to;
        }
        return sum;
    }
};

inline void view(const Target& t, const Viewpoints& points, ViewFactors& factors) {
    const std::size_t n = t.sides.size(), count = t.rims.size();
    const std::size_t obstacles = t.first_rim.size() - 1;
    t.scratch.resize((count * (3 + n) + n + 2 * obstacles) * EXITANCE_LANES);
    float* const a = t.scratch.data();
    float* const b = a + count * EXITANCE_LANES;
    float* const sign = b + count * EXITANCE_LANES;
    float* const corner_value = sign + count * EXITANCE_LANES;
    float* const over_side = corner_value + count * n * EXITANCE_LANES;
    float* const parts = over_side + n * EXITANCE_LANES;
    for (std::size_t first = 0; first < Viewpoints::capacity; first += EXITANCE_LANES) {
        const Point p{load(&points.x[first]), load(&points.y[first]), load(&points.z[first])};
        const Wide over_plane = height(t.plane, p);
        for (std::size_t e = 0; e < n; ++e)
            store(over_side + e * EXITANCE_LANES, height(t.sides[e].outward, p));
        // The plane through x and a rim: h_L(x) h_R − h_R(x) h_L, positive outside the obstacle.
        for (std::size_t r = 0; r < count; ++r) {
            const Target::Rim& rim = t.rims[r];
            const Wide left = height(rim.left, p), right = height(rim.right, p);
            Wide s = left > 0.0f ? wide(1) : wide(-1);
            if (!rim.sheet) s = (left > 0.0f) != (right > 0.0f) ? s : wide(0);
            store(sign + r * EXITANCE_LANES, s);
            store(a + r * EXITANCE_LANES, left * s);
            store(b + r * EXITANCE_LANES, right * s);
            for (std::size_t c = 0; c < n; ++c) {
                const Target::Heights& h = t.corner_over_rim[r * n + c];
                store(corner_value + (r * n + c) * EXITANCE_LANES,
                      left * s * h.right - right * s * h.left);
            }
        }
        Wide free = wide(0), seen = wide(0);
        for (std::size_t e = 0; e < n; ++e) {
            const SeenLine line(t.sides[e].line, p, t.receiver);
            const Wide whole = line.angle(wide(0), wide(1));
            const std::size_t next = e + 1 < n ? e + 1 : 0;
            Covered covered{parts};
            for (std::size_t k = 0; k < obstacles; ++k) {
                Interval part{wide(0), wide(1)};
                for (std::size_t r = t.first_rim[k]; r < t.first_rim[k + 1]; ++r) {
                    const Alike alike = t.side_on_rim[r * n + e];
                    if (alike == Alike::no) {
                        part.keep_below(load(corner_value + (r * n + e) * EXITANCE_LANES),
                                        load(corner_value + (r * n + next) * EXITANCE_LANES));
                    } else {
                        // On the rim itself: behind the obstacle if target and obstacle lie on the
                        // same side of the line.
                        const Wide s = load(sign + r * EXITANCE_LANES);
                        const Wide away = alike == Alike::same_way ? -s : s;
                        part.from = away > 0.0f ? wide(2) : part.from;
                    }
                }
                covered.add(part);
            }
            free += line.weight * whole;
            seen += line.weight * (covered.count ? whole - covered.angle(line) : whole);
        }
        for (std::size_t r = 0; r < count; ++r) {
            const Target::Rim& rim = t.rims[r];
            const Wide s = load(sign + r * EXITANCE_LANES);
            Interval own{wide(0), s * s};
            for (std::size_t e = 0; e < n; ++e) {
                if (t.side_on_rim[r * n + e] != Alike::no) own.drop();
                const Wide g = load(over_side + e * EXITANCE_LANES);
                own.keep_below(
                    over_plane * t.rim_over_side[r * n + e][0] - g * t.rim_over_plane[r][0],
                    over_plane * t.rim_over_side[r * n + e][1] - g * t.rim_over_plane[r][1]);
            }
            const WideMask inside = own.from < own.to;
            if (!any(inside)) continue;
            Covered covered{parts};
            for (std::size_t k = 0; k < obstacles; ++k) {
                if (k == rim.obstacle) continue;
                Interval part = own;
                for (std::size_t q = t.first_rim[k]; q < t.first_rim[k + 1]; ++q) {
                    const Alike alike = t.rim_on_rim[r * count + q];
                    if (alike == Alike::no) {
                        const auto& h = t.rim_over_rim[r * count + q];
                        const Wide l = load(a + q * EXITANCE_LANES),
                                   m = load(b + q * EXITANCE_LANES);
                        part.keep_below(l * h[0].right - m * h[0].left,
                                        l * h[1].right - m * h[1].left);
                    } else {
                        // Two rims on one line: of obstacles on the same side of it one counts, on
                        // different sides both do and cancel.
                        const Wide other = load(sign + q * EXITANCE_LANES) * s;
                        const Wide same = alike == Alike::same_way ? other : -other;
                        if (k < rim.obstacle)
                            part.from = same < 0.0f ? wide(2) : part.from;
                        else
                            part.from = other != 0.0f ? wide(2) : part.from;
                    }
                }
                covered.add(part);
            }
            const SeenLine line(rim.line, p, t.receiver);
            Wide angle = line.angle(own.from, own.to);
            if (covered.count) angle -= covered.angle(line);
            seen -= inside ? s * line.weight * angle : wide(0);
        }
        // Seen from its front the outline runs counter-clockwise, which makes the sums negative.
        constexpr float share = -0.5f / std::numbers::pi_v<float>;
        free = wide_max(free * share, wide(0));
        seen = wide_min(wide_max(seen * share, wide(0)), free);
        store(&factors.free[first], free);
        store(&factors.seen[first], seen);
    }
}
