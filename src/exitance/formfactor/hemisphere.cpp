// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/hemisphere.h"

#include <algorithm>
#include <limits>

#include "exitance/formfactor/batches.h"
#include "exitance/formfactor/facet_caster.h"
#include "exitance/formfactor/facet_samples.h"
#include "exitance/formfactor/pairs_of_facets.h"
#include "exitance/math/frame.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::uint32_t first_rays = 64, most_rays = 131072;  // of a batch

// How often each surface was met, batch by batch.
class Hits {
  public:
    explicit Hits(std::size_t rows) : counts_(rows) {}

    void add(std::uint32_t row, std::size_t batch) {
        if (std::all_of(counts_[row].begin(), counts_[row].end(),
                        [](std::uint32_t c) { return c == 0; }))
            met_.push_back(row);
        ++counts_[row][batch];
    }
    const std::vector<std::uint32_t>& met() const { return met_; }
    std::array<double, batches> shares(std::uint32_t row, std::uint32_t rays) const {
        std::array<double, batches> out{};
        for (std::size_t k = 0; k < batches; ++k) out[k] = double(counts_[row][k]) / rays;
        return out;
    }
    void clear() {
        for (const std::uint32_t row : met_) counts_[row].fill(0);
        met_.clear();
    }

  private:
    std::vector<std::array<std::uint32_t, batches>> counts_;
    std::vector<std::uint32_t> met_;
};

void cast(const FacetCaster& caster, const Enclosure& enclosure, const Facet& facet,
          std::uint64_t key, std::size_t batch, std::uint32_t begin, std::uint32_t end,
          Hits& hits) {
    const FacetPlaces places(facet);
    const Frame frame(facet.normal);
    const Vec3 lift = facet.normal * caster.rays().clearance() - caster.rays().middle();
    RayPacket rays;
    rays.near.fill(0.0f);
    RayCaster::PacketHits found;
    for (std::uint32_t first = begin; first < end; first += RayPacket::width) {
        rays.active = 0;
        rays.far.fill(std::numeric_limits<float>::infinity());
        for (std::uint32_t lane = 0; lane < RayPacket::width && first + lane < end; ++lane) {
            const auto u = low_discrepancy_4(key, first + lane);
            rays.aim(lane, places({u[0], u[1]}) + lift,
                     frame.to_world(cosine_hemisphere({u[2], u[3]})));
        }
        caster.rays().closest(rays, found);
        for (std::uint32_t lane = 0; lane < RayPacket::width; ++lane) {
            if (found.primitive[lane] == 0xffffffffU) continue;
            const std::uint32_t met =
                caster.facet(found.primitive[lane], (found.front >> lane & 1U) != 0);
            if (met == BlockingFacet::none) continue;
            const std::uint32_t row = enclosure.facets[met].row;
            if (row != Facet::only_blocks) hits.add(row, batch);
        }
    }
}

}  // namespace

FormFactorMatrix hemisphere_form_factors(const MethodCall& call) {
    const MethodOptions& options = call.options;
    const Enclosure& enclosure = call.enclosure;
    const FacetCaster caster(enclosure);
    const auto facets = facets_of_rows(enclosure);
    FormFactorMatrix F(surface_areas(enclosure));
    WorkDone done(call, static_cast<double>(facets.size()));
    const std::uint32_t fixed =
        options.samples
            ? std::max(1U, static_cast<std::uint32_t>(*options.samples) / std::uint32_t(batches))
            : 0;
    constexpr std::size_t block = 4;
    parallel_blocks(facets.size(), block, [&](std::size_t begin, std::size_t end) {
        Hits hits(facets.size());
        for (std::size_t i = begin; i < end && done.wanted(); ++i) {
            std::vector<double> row(facets.size());
            for (const std::uint32_t f : facets[i]) {
                const Facet& facet = enclosure.facets[f];
                const double share = facet.area / F.areas()[i];
                // Errors of a row's facets are independent: Σ share² σ² = accuracy².
                const double tolerance = options.accuracy / std::sqrt(share);
                std::uint32_t cast_so_far = 0, next = fixed ? fixed : first_rays;
                for (;;) {
                    for (std::size_t k = 0; k < batches; ++k)
                        cast(caster, enclosure, facet, hash_bits(options.seed, f, k), k,
                             cast_so_far, next, hits);
                    call.counters.rays += batches * (next - cast_so_far);
                    cast_so_far = next;
                    double worst = 0;
                    for (const std::uint32_t j : hits.met())
                        worst = std::max(worst, standard_error(hits.shares(j, cast_so_far)));
                    if (fixed || worst <= tolerance) break;
                    if (cast_so_far >= most_rays) {
                        ++call.counters.unreached;
                        break;
                    }
                    next = 2 * cast_so_far;
                }
                for (const std::uint32_t j : hits.met())
                    for (const double s : hits.shares(j, cast_so_far))
                        row[j] += share * s / double(batches);
                hits.clear();
            }
            F.set_row(i, row);
            done.add(1);
        }
    });
    return F;
}

}  // namespace exitance
