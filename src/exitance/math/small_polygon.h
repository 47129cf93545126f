// SPDX-License-Identifier: Apache-2.0
// Convex polygons of few corners that are cut by planes without touching the heap.
#pragma once

#include <array>
#include <cassert>
#include <span>

#include "exitance/math/vector.h"

namespace exitance {

struct Plane {
    Vec3 normal;        ///< unit
    double offset = 0;  ///< height(p) = normal · p − offset

    double height(const Vec3& p) const { return dot(normal, p) - offset; }
    Plane flipped() const { return {-normal, -offset}; }
};

struct SmallPolygon {
    static constexpr std::size_t capacity = 12;
    std::array<Vec3, capacity> at;
    std::size_t count = 0;

    SmallPolygon() = default;
    explicit SmallPolygon(std::span<const Vec3> corners) {
        for (const Vec3& c : corners) add(c);
    }
    void add(const Vec3& p) {
        assert(count < capacity);
        at[count++] = p;
    }
    std::span<const Vec3> corners() const { return {at.data(), count}; }
    bool empty() const { return count < 3; }
};

/// The part of a convex polygon where the plane's height is positive; corners within `slack` of the
/// plane count as on it. Empty if nothing rises above the slack (Sutherland & Hodgman 1974).
inline SmallPolygon clip(const SmallPolygon& polygon, const Plane& plane, double slack) {
    std::array<double, SmallPolygon::capacity> height;
    double lowest = 0, highest = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        height[i] = plane.height(polygon.at[i]);
        lowest = std::min(lowest, height[i]);
        highest = std::max(highest, height[i]);
    }
    if (highest <= slack) return {};
    if (lowest >= -slack) return polygon;
    SmallPolygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const std::size_t j = i + 1 < polygon.count ? i + 1 : 0;
        if (height[i] >= 0) kept.add(polygon.at[i]);
        if ((height[i] > 0 && height[j] < 0) || (height[i] < 0 && height[j] > 0))
            kept.add(polygon.at[i] +
                     (polygon.at[j] - polygon.at[i]) * (height[i] / (height[i] - height[j])));
    }
    return kept;
}

}  // namespace exitance
