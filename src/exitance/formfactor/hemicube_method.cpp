// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/facet_samples.h"
#include "exitance/formfactor/hemicube.h"
#include "exitance/formfactor/pairs_of_facets.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::size_t most_cells_a_side = 8;

std::size_t resolution_of(const MethodOptions& options) {
    const double wanted =
        options.resolution.value_or(std::clamp(4 / std::sqrt(options.accuracy), 32.0, 1024.0));
    return 2 * static_cast<std::size_t>(std::ceil(wanted / 2));
}

Frame rotated(const Vec3& normal, double angle) {
    Frame frame(normal);
    const Vec3 t = frame.tangent, b = frame.bitangent;
    frame.tangent = t * std::cos(angle) + b * std::sin(angle);
    frame.bitangent = b * std::cos(angle) - t * std::sin(angle);
    return frame;
}

class HemicubeRow {
  public:
    HemicubeRow(const MethodCall& call, std::span<const BlockingFacet> blockers)
        : call_(call), blockers_(blockers), hemicube_(resolution_of(call.options)) {}

    // The mean over side² places of the facet, added to `row` times `share`.
    void add(std::uint32_t f, std::size_t side, double share, std::vector<double>& row) {
        const Facet& facet = call_.enclosure.facets[f];
        const auto cells = facet_cells(facet, side);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            // Rotation makes the aliasing of neighbouring hemicubes independent.
            const double angle =
                call_.options.rotate
                    ? 2 * std::numbers::pi * uniform(hash_bits(call_.options.seed, f, side), c)
                    : 0;
            hemicube_.look(cells[c].middle, rotated(facet.normal, angle), call_.enclosure,
                           blockers_);
            const double weight = share * cells[c].area / facet.area;
            hemicube_.visit_cells([&](std::uint32_t seen, double delta) {
                row[call_.enclosure.facets[seen].row] += weight * delta;
            });
        }
        call_.counters.evaluations += cells.size();
    }

  private:
    const MethodCall& call_;
    std::span<const BlockingFacet> blockers_;
    Hemicube hemicube_;
};

double largest_change(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
}

}  // namespace

FormFactorMatrix hemicube_form_factors(const MethodCall& call) {
    const MethodOptions& options = call.options;
    const std::vector<BlockingFacet> blockers = blocking_facets(call.enclosure);
    const auto facets = facets_of_rows(call.enclosure);
    FormFactorMatrix F(surface_areas(call.enclosure));
    WorkDone done(call, static_cast<double>(facets.size()));
    parallel_blocks(facets.size(), 4, [&](std::size_t begin, std::size_t end) {
        HemicubeRow hemicubes(call, blockers);
        for (std::size_t i = begin; i < end && done.wanted(); ++i) {
            const auto estimate = [&](std::size_t side) {
                std::vector<double> row(facets.size());
                for (const std::uint32_t f : facets[i])
                    hemicubes.add(f, side, call.enclosure.facets[f].area / F.areas()[i], row);
                return row;
            };
            std::size_t side =
                options.samples ? static_cast<std::size_t>(std::ceil(std::sqrt(*options.samples)))
                                : 2;
            std::vector<double> row = estimate(side);
            while (!options.samples) {
                std::vector<double> finer = estimate(2 * side);
                const double change = largest_change(row, finer);
                row = std::move(finer);
                side *= 2;
                if (change <= options.accuracy) break;
                if (side < most_cells_a_side) continue;
                ++call.counters.unreached;
                break;
            }
            F.set_row(i, row);
            done.add(1);
        }
    });
    return F;
}

}  // namespace exitance
