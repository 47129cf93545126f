// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/contour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/facing_parts.h"
#include "exitance/formfactor/pair_visibility.h"
#include "exitance/formfactor/pairs_of_facets.h"
#include "exitance/math/quadrature.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::size_t most_segments = 32;
constexpr double most_parts = 1024;

// ∫∫ ln r ds dt over two edges, s and t from 0 to 1.
double mean_logarithm(const Vec3& a, const Vec3& along_a, std::size_t segments_a, const Vec3& b,
                      const Vec3& along_b, std::size_t segments_b) {
    const double size = dot(along_a, along_a) + dot(along_b, along_b);
    const double close = 1e-24 * size;
    const Vec3 a_end = a + along_a, b_end = b + along_b;
    const auto same = [&](const Vec3& p, const Vec3& q) { return dot(p - q, p - q) <= close; };
    // The same edge on both: ∫∫ ln(L |s − t|) = ln L − 3/2.
    if ((same(a, b) && same(a_end, b_end)) || (same(a, b_end) && same(a_end, b)))
        return 0.5 * std::log(dot(along_a, along_a)) - 1.5;
    const auto& rule = gauss_legendre<4>();
    const double step_a = 1.0 / static_cast<double>(segments_a),
                 step_b = 1.0 / static_cast<double>(segments_b);
    double sum = 0;
    for (std::size_t i = 0; i < 4 * segments_a; ++i) {
        const Vec3 x = a + along_a * ((static_cast<double>(i / 4) + rule.at[i % 4]) * step_a);
        double inner = 0;
        for (std::size_t j = 0; j < 4 * segments_b; ++j) {
            const Vec3 y = b + along_b * ((static_cast<double>(j / 4) + rule.at[j % 4]) * step_b);
            inner += rule.weight[j % 4] * std::log(std::max(dot(x - y, x - y), close));
        }
        sum += rule.weight[i % 4] * inner;
    }
    return 0.5 * sum * step_a * step_b;
}

}  // namespace

double contour_exchange_area(std::span<const Vec3> a, std::span<const Vec3> b,
                             std::size_t segments) {
    double shortest = INFINITY;
    for (const auto& outline : {a, b})
        for (std::size_t i = 0; i < outline.size(); ++i)
            shortest = std::min(shortest, length(outline[(i + 1) % outline.size()] - outline[i]));
    const auto parts = [&](const Vec3& edge) {
        const double times = std::min(length(edge) / shortest, most_parts);
        return static_cast<std::size_t>(
            std::clamp(std::round(static_cast<double>(segments) * times), 1.0, most_parts));
    };
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec3 along_a = a[(i + 1) % a.size()] - a[i];
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Vec3 along_b = b[(j + 1) % b.size()] - b[j];
            const double turned = dot(along_a, along_b);
            if (turned == 0) continue;
            sum += turned *
                   mean_logarithm(a[i], along_a, parts(along_a), b[j], along_b, parts(along_b));
        }
    }
    return std::max(0.0, sum / (2 * std::numbers::pi));
}

FormFactorMatrix contour_form_factors(const MethodCall& call) {
    const MethodOptions& options = call.options;
    const FacetCaster caster(call.enclosure);
    const auto unobstructed = [&](const FacingParts& parts, double tolerance) {
        if (options.samples)
            return contour_exchange_area(parts.a, parts.b,
                                         static_cast<std::size_t>(*options.samples));
        double last = contour_exchange_area(parts.a, parts.b, 1);
        for (std::size_t segments = 2; segments <= most_segments; segments *= 2) {
            const double next = contour_exchange_area(parts.a, parts.b, segments);
            if (std::abs(next - last) <= tolerance) return next;
            last = next;
        }
        ++call.counters.unreached;
        return last;
    };
    return {surface_areas(call.enclosure),
            exchange_by_pairs(call, [&](std::uint32_t f, std::uint32_t g) {
                const Facet &a = call.enclosure.facets[f], &b = call.enclosure.facets[g];
                const FacingParts parts = facing_parts(a, b);
                if (parts.a.empty()) return 0.0;
                ++call.counters.evaluations;
                const double tolerance = options.accuracy * std::min(a.area, b.area);
                const double S = unobstructed(parts, tolerance);
                if (S <= 0) return 0.0;
                return visible_exchange_area(caster, a, b, hash_bits(options.seed, f, g), S,
                                             tolerance, call.counters);
            })};
}

}  // namespace exitance
