// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pair_visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/batches.h"
#include "exitance/formfactor/facet_samples.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr double least_rays = 16, most_rays = 131072;

}  // namespace

PairSums sample_pair(const FacetCaster& caster, const Facet& a, const Facet& b, std::uint64_t key,
                     std::uint32_t begin, std::uint32_t end) {
    const FacetPlaces on_a(a), on_b(b);
    const Vec3 middle = caster.rays().middle();
    const double clearance = caster.rays().clearance();
    PairSums sums;
    for (std::uint32_t first = begin; first < end; first += RayPacket::width) {
        RayPacket rays;
        rays.near.fill(0.0f);
        rays.far.fill(1.0f);
        std::array<double, RayPacket::width> kernel{};
        for (std::uint32_t lane = 0; lane < RayPacket::width && first + lane < end; ++lane) {
            const auto u = low_discrepancy_4(key, first + lane);
            const Vec3 x = on_a({u[0], u[1]}), y = on_b({u[2], u[3]});
            const Vec3 d = y - x;
            const double square = dot(d, d);
            const double cosines = dot(d, a.normal) * -dot(d, b.normal);
            if (dot(d, a.normal) <= 0 || cosines <= 0) continue;
            kernel[lane] = cosines / (std::numbers::pi * square * square);
            const Vec3 from = x + a.normal * clearance;
            rays.aim(lane, from - middle, y + b.normal * clearance - from);
        }
        // What is not aimed keeps whatever it was; its lane is off.
        const std::uint32_t blocked = rays.active ? caster.rays().occluded(rays) : 0;
        for (std::size_t lane = 0; lane < RayPacket::width; ++lane) {
            sums.all += kernel[lane];
            if ((blocked >> lane & 1U) == 0) sums.seen += kernel[lane];
        }
    }
    return sums;
}

double visible_exchange_area(const FacetCaster& caster, const Facet& a, const Facet& b,
                             std::uint64_t key, double S, double tolerance,
                             MethodCounters& counters) {
    const double probes =
        std::clamp(std::pow(2 * tolerance / S, -4.0 / 3) / 4, least_rays, 0.25 * most_rays);
    std::array<PairSums, batches> sums{};
    std::uint32_t rays = 0;
    auto next = static_cast<std::uint32_t>(std::ceil(probes / double(batches)));
    for (;;) {
        PairSums whole;
        for (std::size_t k = 0; k < batches; ++k) {
            const PairSums more = sample_pair(caster, a, b, hash_bits(key, k), rays, next);
            sums[k].seen += more.seen;
            sums[k].all += more.all;
            whole.seen += sums[k].seen;
            whole.all += sums[k].all;
        }
        counters.rays += batches * (next - rays);
        rays = next;
        if (whole.all <= 0) return S;  // too thin to be met; nothing is known against it
        if (whole.seen <= 0) return 0;
        if (whole.seen >= whole.all) return S;
        std::array<double, batches> seen{}, blocked{};
        const double scale = a.area * b.area / rays;
        for (std::size_t k = 0; k < batches; ++k) {
            seen[k] = scale * sums[k].seen;
            blocked[k] = scale * (sums[k].all - sums[k].seen);
        }
        const double seen_error = standard_error(seen), blocked_error = standard_error(blocked);
        const bool enough = std::min(seen_error, blocked_error) <= tolerance;
        if (!enough && rays * batches < static_cast<std::size_t>(most_rays)) {
            next = 2 * rays;
            continue;
        }
        if (!enough) ++counters.unreached;
        const double mean = scale / double(batches);
        const double through =
            seen_error <= blocked_error ? mean * whole.seen : S - mean * (whole.all - whole.seen);
        return std::clamp(through, 0.0, S);
    }
}

}  // namespace exitance
