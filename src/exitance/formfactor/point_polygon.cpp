// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/point_polygon.h"

#include <algorithm>
#include <numbers>

#include "exitance/math/polygon.h"

namespace exitance {

namespace {

// θ Γ·n of one edge: the angle it subtends times the receiver normal's part across its plane.
double edge_term(const Vec3& a, const Vec3& b, const Vec3& normal) {
    const Vec3 gamma = cross(a, b);
    const double sine = length(gamma);
    return sine > 0 ? std::atan2(sine, dot(a, b)) / sine * dot(gamma, normal) : 0.0;
}

}  // namespace

double point_polygon_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners) {
    if (dot(vector_area(corners), point - corners[0]) <= 0) return 0;
    double sum = 0;
    Vec3 leaves, enters;  // where the outline sinks below the horizon and rises again
    bool cut = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec3 a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
        const double height_a = dot(a, normal), height_b = dot(b, normal);
        if (height_a <= 0 && height_b <= 0) continue;
        if (height_a <= 0) {
            a += (b - a) * (height_a / (height_a - height_b));
            enters = a;
            cut = true;
        } else if (height_b <= 0) {
            b = a + (b - a) * (height_a / (height_a - height_b));
            leaves = b;
            cut = true;
        }
        sum += edge_term(a, b, normal);
    }
    if (cut) sum += edge_term(leaves, enters, normal);
    // Seen from its front the outline runs counter-clockwise, which makes the sum negative.
    return std::clamp(-sum / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace exitance
