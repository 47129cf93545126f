// SPDX-License-Identifier: Apache-2.0
// Area, normal and flatness of planar polygons given by their corners in order.
#pragma once

#include <span>

#include "exitance/math/vector.h"

namespace exitance {

/// Vector area: length = area, direction = normal by the right-hand rule (Newell's method).
inline Vec3 vector_area(std::span<const Vec3> corners) {
    Vec3 sum;
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum * 0.5;
}

inline double area(std::span<const Vec3> corners) {
    return length(vector_area(corners));
}

inline Vec3 unit_normal(std::span<const Vec3> corners) {
    return normalized(vector_area(corners));
}

/// Whether the outline turns the same way at every corner, and at none goes straight on.
inline bool is_strictly_convex(std::span<const Vec3> corners) {
    const Vec3 normal = vector_area(corners);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()],
                   &c = corners[(i + 2) % corners.size()];
        if (!(dot(cross(b - a, c - b), normal) > 0)) return false;
    }
    return true;
}

/// Length of the longest side.
inline double longest_side(std::span<const Vec3> corners) {
    double longest = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        longest = std::max(longest, length(corners[(i + 1) % corners.size()] - corners[i]));
    return longest;
}

/// Mean of the corners.
inline Vec3 centroid(std::span<const Vec3> corners) {
    Vec3 sum;
    for (const Vec3& c : corners) sum += c;
    return sum / static_cast<double>(corners.size());
}

/// Largest distance of a corner from `centre`.
inline double radius_about(const Vec3& centre, std::span<const Vec3> corners) {
    double radius = 0;
    for (const Vec3& c : corners) radius = std::max(radius, length(c - centre));
    return radius;
}

/// Largest distance of a corner from the plane through the mean of the corners.
inline double planarity_error(std::span<const Vec3> corners) {
    const Vec3 n = unit_normal(corners), c = centroid(corners);
    double worst = 0;
    for (const Vec3& p : corners) worst = std::max(worst, std::abs(dot(p - c, n)));
    return worst;
}

}  // namespace exitance
