// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pairwise_method.h"

#include <algorithm>

#include "exitance/formfactor/pair_visibility.h"
#include "exitance/formfactor/pairs_of_facets.h"
#include "exitance/formfactor/pairwise.h"
#include "exitance/formfactor/polygon_polygon.h"
#include "exitance/run/random.h"

namespace exitance {

FormFactorMatrix pairwise_form_factors(const MethodCall& call) {
    PairwiseCounters counters;
    ExchangeAreas S = pairwise_exchange_areas(call.enclosure, {call.options.accuracy}, call.observe,
                                              call.cancel, &counters);
    call.counters.evaluations += counters.pairs;
    call.counters.rays += counters.rays;
    call.counters.unreached += counters.unreached;
    return {surface_areas(call.enclosure), std::move(S)};
}

FormFactorMatrix analytic_form_factors(const MethodCall& call) {
    const FacetCaster caster(call.enclosure);
    return {surface_areas(call.enclosure),
            exchange_by_pairs(call, [&](std::uint32_t f, std::uint32_t g) {
                const Facet &a = call.enclosure.facets[f], &b = call.enclosure.facets[g];
                const double S = exchange_area(a.corners(), b.corners());
                ++call.counters.evaluations;
                if (S <= 0) return 0.0;
                return visible_exchange_area(caster, a, b, hash_bits(call.options.seed, f, g), S,
                                             call.options.accuracy * std::min(a.area, b.area),
                                             call.counters);
            })};
}

}  // namespace exitance
