// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/surface_probe.h"

#include <array>
#include <cmath>

namespace exitance {

namespace {

// Barycentric weights of the point of a triangle nearest to p: the region of the triangle's
// corners, edges and face that p projects to (Ericson 2005, Real-Time Collision Detection, 5.1.5).
std::array<double, 3> nearest_weights(const Vec3& p, const std::array<Vec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = d1 / (d1 - d3);
        return {1 - v, v, 0};
    }
    const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = d2 / (d2 - d6);
        return {1 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

}  // namespace

std::optional<SurfacePlace> find_surface(const Surfaces& surfaces, const Vec3& point,
                                         const Vec3& normal, const SurfaceProbeOptions& options) {
    // Distances that differ by less than a few float steps are equal; then facing decides.
    const double step = surfaces.caster().clearance();
    const double reach = std::max(options.tolerance * surfaces.diagonal(), step);
    std::optional<SurfacePlace> best;
    double best_score = 0;
    surfaces.caster().visit_near(point, reach, [&](std::uint32_t triangle, double radius) {
        const std::array<Vec3, 3> corners = surfaces.corners(triangle);
        const Vec3 n = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
        const double facing = dot(n, normal);
        if (!(facing > options.least_facing)) return radius;
        const auto w = nearest_weights(point, corners);
        const Vec3 nearest = corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
        const double distance = length(point - nearest);
        if (distance > reach) return radius;
        const double score = distance + step * (1 - facing);
        if (best && (score > best_score || (score == best_score && triangle > best->triangle)))
            return radius;
        best = SurfacePlace{triangle, w};
        best_score = score;
        return std::min(radius, score + step);
    });
    return best;
}

bool probe_surface(const Surfaces& surfaces, const Vec3& point, const Vec3& normal,
                   std::span<double> columns, const SurfaceProbeOptions& options) {
    const auto place = find_surface(surfaces, point, normal, options);
    if (place) surfaces.irradiance(*place, columns);
    return place.has_value();
}

}  // namespace exitance
