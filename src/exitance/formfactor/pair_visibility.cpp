// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pair_visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/batches.h"
#include "exitance/formfactor/facet_samples.h"
#include "exitance/math/polygon.h"
#include "exitance/math/spherical_triangle.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr double least_rays = 16, most_rays = 131072;

/// Places on a facet as they are seen from a point.
class SeenFacet {
  public:
    explicit SeenFacet(const Facet& facet)
        : facet_(facet),
          places_(facet),
          centre_(centroid(facet.corners())),
          radius_(radius_about(centre_, facet.corners())) {}

    struct Place {
        Vec3 at;
        double factor = 0;  ///< its mean is the form factor from x; 0: not to be asked for
    };
    Place from(const Vec3& x, const Vec3& normal, const UnitSquare& u) const {
        const double height = dot(x - facet_.outline[0], facet_.normal);
        if (height <= 0) return {};
        // An even kernel from three radii on: distances there differ by a factor of two.
        if (length(centre_ - x) > 3 * radius_) {
            const Vec3 at = places_(u), d = at - x;
            const double square = dot(d, d);
            const double cosines = dot(d, normal) * -dot(d, facet_.normal);
            return {at, cosines / (std::numbers::pi * square * square) * facet_.area};
        }
        const auto& c = facet_.outline;
        const SphericalTriangle first(c[0] - x, c[1] - x, c[2] - x);
        if (facet_.count == 3)
            return toward(x, normal, height, first.direction(u), first.solid_angle());
        const SphericalTriangle second(c[0] - x, c[2] - x, c[3] - x);
        const double whole = first.solid_angle() + second.solid_angle();
        const double share = first.solid_angle() / whole;
        const Vec3 direction = u[0] < share
                                   ? first.direction({u[0] / share, u[1]})
                                   : second.direction({(u[0] - share) / (1 - share), u[1]});
        return toward(x, normal, height, direction, whole);
    }

  private:
    Place toward(const Vec3& x, const Vec3& normal, double height, const Vec3& direction,
                 double solid_angle) const {
        const double down = -dot(direction, facet_.normal);
        if (!(down > 0)) return {};
        return {x + direction * (height / down),
                dot(direction, normal) * solid_angle / std::numbers::pi};
    }

    const Facet& facet_;
    FacetPlaces places_;
    Vec3 centre_;
    double radius_;
};

}  // namespace

PairSums sample_pair(const FacetCaster& caster, const Facet& a, const Facet& b, std::uint64_t key,
                     std::uint32_t begin, std::uint32_t end) {
    const Facet& small = a.area <= b.area ? a : b;
    const Facet& large = a.area <= b.area ? b : a;
    const FacetPlaces on_small(small);
    const SeenFacet on_large(large);
    const Vec3 middle = caster.rays().middle();
    const double clearance = caster.rays().clearance();
    PairSums sums;
    for (std::uint32_t first = begin; first < end; first += RayPacket::width) {
        RayPacket rays;
        rays.near.fill(0.0f);
        rays.far.fill(1.0f);
        std::array<double, RayPacket::width> factor{};
        for (std::uint32_t lane = 0; lane < RayPacket::width && first + lane < end; ++lane) {
            const auto u = low_discrepancy_4(key, first + lane);
            const Vec3 x = on_small({u[0], u[1]});
            const SeenFacet::Place y = on_large.from(x, small.normal, {u[2], u[3]});
            if (!(y.factor > 0)) continue;
            factor[lane] = y.factor;
            const Vec3 from = x + small.normal * clearance;
            rays.aim(lane, from - middle, y.at + large.normal * clearance - from);
        }
        // What is not aimed keeps whatever it was; its lane is off.
        const std::uint32_t blocked = rays.active ? caster.rays().occluded(rays) : 0;
        for (std::size_t lane = 0; lane < RayPacket::width; ++lane) {
            sums.all += small.area * factor[lane];
            if ((blocked >> lane & 1U) == 0) sums.seen += small.area * factor[lane];
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
        const double scale = 1.0 / rays;
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
