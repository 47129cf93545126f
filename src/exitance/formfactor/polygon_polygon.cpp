// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/polygon_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exitance/math/polygon.h"
#include "exitance/math/quadrature.h"
#include "exitance/math/small_polygon.h"

namespace exitance {

namespace {

struct Edge {
    Vec3 from, direction;  // unit
    double length = 0;

    Edge(const Vec3& a, const Vec3& b)
        : from(a), direction(b - a), length(exitance::length(b - a)) {
        if (length > 0) direction = direction / length;
    }
    Vec3 at(double s) const { return from + direction * s; }
};

// ∫ ln √(u² + h²) du.
double log_distance_integral(double u, double h) {
    const double r2 = u * u + h * h;
    return r2 > 0 ? 0.5 * u * std::log(r2) - u + h * std::atan2(u, h) : 0;
}

// ∫ ln r along the whole of `edge`, seen from `point`.
double inner_integral(const Vec3& point, const Edge& edge) {
    const Vec3 to = edge.from - point;
    const double u = dot(to, edge.direction), h = length(cross(to, edge.direction));
    return log_distance_integral(u + edge.length, h) - log_distance_integral(u, h);
}

// Where the integrand is smooth over an edge's length, plain Gauss; at ends where the edges come
// near each other it has logarithms: s = τ³(10 − 15τ + 6τ²) presses the points towards both ends.
template <std::size_t N>
double outer_rule(const Edge& outer, double begin, double end, const Edge& inner, bool graded) {
    const auto& rule = gauss_legendre<N>();
    double sum = 0;
    for (std::size_t k = 0; k < N; ++k) {
        const double t = rule.at[k];
        const double s = graded ? t * t * t * (10 + t * (6 * t - 15)) : t;
        const double slope = graded ? 30 * t * t * (1 - t) * (1 - t) : 1;
        sum += rule.weight[k] * slope * inner_integral(outer.at(begin + (end - begin) * s), inner);
    }
    return sum * (end - begin);
}

double graded_integral(const Edge& outer, double begin, double end, const Edge& inner,
                       double tolerance, int depth) {
    const double coarse = outer_rule<10>(outer, begin, end, inner, true);
    if (tolerance > 1e-4) return coarse;
    const double fine = outer_rule<16>(outer, begin, end, inner, true);
    if (depth == 0 || std::abs(fine - coarse) <= tolerance) return fine;
    const double middle = 0.5 * (begin + end);
    return graded_integral(outer, begin, middle, inner, 0.5 * tolerance, depth - 1) +
           graded_integral(outer, middle, end, inner, 0.5 * tolerance, depth - 1);
}

// ∫∫ ln r ds dt over two edges.
double edge_pair(const Edge& outer, const Edge& inner, double tolerance) {
    // Nearest they can be, from the middles of both.
    const double gap = length(outer.at(0.5 * outer.length) - inner.at(0.5 * inner.length)) -
                       0.5 * (outer.length + inner.length);
    if (gap > outer.length && tolerance > 1e-9)
        return outer_rule<6>(outer, 0, outer.length, inner, false);
    if (gap > 0.5 * outer.length) return outer_rule<16>(outer, 0, outer.length, inner, false);
    // Singular points lie where the outer edge passes the ends of the inner one, and the inner
    // line.
    std::array<double, 5> breaks{0, outer.length, outer.length, outer.length, outer.length};
    const auto add = [&](double s) {
        if (!(s > 1e-9 * outer.length && s < (1 - 1e-9) * outer.length)) return;
        breaks[4] = s;
        std::sort(breaks.begin(), breaks.end());
    };
    add(dot(inner.from - outer.from, outer.direction));
    add(dot(inner.at(inner.length) - outer.from, outer.direction));
    const double along = dot(outer.direction, inner.direction), sine2 = 1 - along * along;
    if (sine2 > 1e-6) {
        const Vec3 w = inner.from - outer.from;
        add((dot(w, outer.direction) - along * dot(w, inner.direction)) / sine2);
    }
    double sum = 0;
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
        if (breaks[k + 1] > breaks[k])
            sum += graded_integral(outer, breaks[k], breaks[k + 1], inner, tolerance, 14);
    return sum;
}

Plane plane_of(std::span<const Vec3> corners) {
    const Vec3 normal = unit_normal(corners);
    return {normal, dot(normal, corners[0])};
}

}  // namespace

double exchange_area(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance) {
    const Vec3 middle_a = centroid(a), middle_b = centroid(b);
    const double reach = radius_about(middle_a, a) + radius_about(middle_b, b);
    const double distance = length(middle_b - middle_a), scale = distance + reach;
    if (!(scale > 0)) return 0;
    const double slack = 1e-12 * scale;
    SmallPolygon p = clip(SmallPolygon(a), plane_of(b), slack);
    SmallPolygon q = clip(SmallPolygon(b), plane_of(a), slack);
    if (p.empty() || q.empty()) return 0;
    const double area_p = area(p.corners()), area_q = area(q.corners());
    if (!(area_p > 0) || !(area_q > 0)) return 0;
    // In units of the distance, so that logarithms of far pairs do not cancel.
    for (std::size_t i = 0; i < p.count; ++i) p.at[i] = (p.at[i] - middle_a) / scale;
    for (std::size_t i = 0; i < q.count; ++i) q.at[i] = (q.at[i] - middle_a) / scale;
    const double least = std::min(area_p, area_q) / (scale * scale);
    // S = 1/2π Σ Σ cos(e, f) ∫∫ ln r ds dt (Sparrow 1963, eq. 10; Goral et al. 1984, eq. 7).
    const double share = tolerance * least * 2 * std::numbers::pi / 16;
    double sum = 0;
    for (std::size_t i = 0; i < p.count; ++i) {
        const Edge e(p.at[i], p.at[(i + 1) % p.count]);
        for (std::size_t j = 0; j < q.count; ++j) {
            const Edge f(q.at[j], q.at[(j + 1) % q.count]);
            const double cosine = dot(e.direction, f.direction);
            if (std::abs(cosine) < 1e-15 || e.length == 0 || f.length == 0) continue;
            // The shorter edge is the outer one: over it the integrand varies less.
            sum +=
                cosine * (e.length <= f.length ? edge_pair(e, f, share) : edge_pair(f, e, share));
        }
    }
    const double exchange = sum / (2 * std::numbers::pi) * scale * scale;
    return std::clamp(exchange, 0.0, std::min(area_p, area_q));
}

}  // namespace exitance
