// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/monte_carlo.h"

#include <algorithm>

#include "exitance/formfactor/batches.h"
#include "exitance/formfactor/pair_visibility.h"
#include "exitance/formfactor/pairs_of_facets.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::uint32_t first_places = 16, most_places = 16384;  // of a batch

}  // namespace

FormFactorMatrix monte_carlo_form_factors(const MethodCall& call) {
    const MethodOptions& options = call.options;
    const FacetCaster caster(call.enclosure);
    const auto pair_area = [&](std::uint32_t f, std::uint32_t g) {
        const Facet &a = call.enclosure.facets[f], &b = call.enclosure.facets[g];
        const double tolerance = options.accuracy * std::min(a.area, b.area);
        const std::uint32_t fixed =
            options.samples ? std::max(1U, static_cast<std::uint32_t>(*options.samples) /
                                               std::uint32_t(batches))
                            : 0;
        std::array<double, batches> sums{}, areas{};
        std::uint32_t places = 0, next = fixed ? fixed : first_places;
        for (;;) {
            for (std::size_t k = 0; k < batches; ++k) {
                const std::uint64_t key = hash_bits(options.seed, f, g, k);
                sums[k] += sample_pair(caster, a, b, key, places, next).seen;
                areas[k] = sums[k] / next;
            }
            call.counters.rays += batches * (next - places);
            places = next;
            if (fixed || standard_error(areas) <= tolerance) break;
            if (places >= most_places) {
                ++call.counters.unreached;
                break;
            }
            next = 2 * places;
        }
        ++call.counters.evaluations;
        double mean = 0;
        for (const double area : areas) mean += area / double(batches);
        return mean;
    };
    return {surface_areas(call.enclosure), exchange_by_pairs(call, pair_area)};
}

}  // namespace exitance
