// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/disk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/facet_caster.h"
#include "exitance/formfactor/facet_samples.h"
#include "exitance/formfactor/pairs_of_facets.h"

namespace exitance {

namespace {

constexpr std::size_t most_cells_a_side = 16;

class DiskPair {
  public:
    DiskPair(const FacetCaster& caster, const Facet& receiver, const Facet& source,
             MethodCounters& counters)
        : caster_(caster), receiver_(receiver), source_(source), counters_(counters) {}

    // Σ_x A_x Σ_y V cosθ_x cosθ_y A_y / (π r² + A_y): Wallace's sum at the middle of every cell.
    double exchange_area(std::size_t side, bool rays) {
        const auto receivers = facet_cells(receiver_, side), discs = facet_cells(source_, side);
        counters_.evaluations += receivers.size() * discs.size();
        double sum = 0;
        for (const FacetCell& x : receivers)
            for (const FacetCell& y : discs) {
                const Vec3 d = y.middle - x.middle;
                const double out = dot(d, receiver_.normal), in = -dot(d, source_.normal);
                if (out <= 0 || in <= 0) continue;
                const double square = dot(d, d);
                const double area =
                    x.area * out * in / square * y.area / (std::numbers::pi * square + y.area);
                if (rays)
                    add_ray(x.middle, y.middle, area, sum);
                else
                    sum += area;
            }
        if (rays) cast(sum);
        return sum;
    }

  private:
    void add_ray(const Vec3& x, const Vec3& y, double area, double& sum) {
        const double clearance = caster_.rays().clearance();
        const Vec3 from = x + receiver_.normal * clearance;
        packet_.aim(lanes_, from - caster_.rays().middle(), y + source_.normal * clearance - from);
        areas_[lanes_++] = area;
        if (lanes_ == RayPacket::width) cast(sum);
    }

    void cast(double& sum) {
        packet_.near.fill(0.0f);
        packet_.far.fill(1.0f);
        const std::uint32_t blocked = lanes_ ? caster_.rays().occluded(packet_) : 0;
        counters_.rays += lanes_;
        for (std::size_t lane = 0; lane < lanes_; ++lane)
            if ((blocked >> lane & 1U) == 0) sum += areas_[lane];
        packet_.active = 0;
        lanes_ = 0;
    }

    const FacetCaster& caster_;
    const Facet &receiver_, &source_;
    MethodCounters& counters_;
    RayPacket packet_{};
    std::array<double, RayPacket::width> areas_{};
    std::size_t lanes_ = 0;
};

}  // namespace

FormFactorMatrix disk_form_factors(const MethodCall& call) {
    const MethodOptions& options = call.options;
    const FacetCaster caster(call.enclosure);
    const auto pair_area = [&](std::uint32_t f, std::uint32_t g) {
        const Facet &a = call.enclosure.facets[f], &b = call.enclosure.facets[g];
        const bool first = a.area < b.area;  // receives
        DiskPair pair(caster, first ? a : b, first ? b : a, call.counters);
        if (options.samples)
            return pair.exchange_area(
                static_cast<std::size_t>(std::ceil(std::sqrt(*options.samples))), true);
        const double tolerance = options.accuracy * std::min(a.area, b.area);
        // As fine as the discs without rays need it; then finer while visibility still changes it.
        std::size_t side = 1;
        double last = pair.exchange_area(side, false);
        while (side < most_cells_a_side) {
            const double next = pair.exchange_area(2 * side, false);
            if (next == 0 && side > 1) return 0.0;
            if (std::abs(next - last) <= tolerance) break;
            last = next;
            side *= 2;
        }
        side = std::max<std::size_t>(side, 2);
        last = pair.exchange_area(side, true);
        if (last == pair.exchange_area(side, false)) return last;
        // Cells that stand in line with a shadow change nothing once; twice is no chance.
        std::size_t agreed = 0;
        while (side < most_cells_a_side) {
            const double next = pair.exchange_area(2 * side, true);
            agreed = std::abs(next - last) <= tolerance ? agreed + 1 : 0;
            last = next;
            side *= 2;
            if (agreed == 2) return last;
        }
        ++call.counters.unreached;
        return last;
    };
    return {surface_areas(call.enclosure), exchange_by_pairs(call, pair_area)};
}

}  // namespace exitance
