// SPDX-License-Identifier: Apache-2.0
// How much of what two facets exchange gets through, by rays between sampled places on both.
#pragma once

#include "exitance/formfactor/facet_caster.h"
#include "exitance/formfactor/method.h"

namespace exitance {

/// Σ V k and Σ k over pairs of places, k = cosθ₁ cosθ₂ / (π r²) [1/m²].
struct PairSums {
    double seen = 0, all = 0;
};

/// Casts rays between places begin … end of the 4-dimensional sequence `key`, each lifted off its
/// facet by the caster's clearance.
PairSums sample_pair(const FacetCaster& caster, const Facet& a, const Facet& b, std::uint64_t key,
                     std::uint32_t begin, std::uint32_t end);

/// What gets through of an unobstructed exchange area `S` [m²], wrong by about `tolerance` [m²]:
/// eight independent batches of rays are doubled until their standard error is below. Either what
/// is seen or what is blocked is estimated, whichever varies less: where facets touch the kernel is
/// not bounded, but nothing stands there. (2 · tolerance / S)^-4/3 / 4 rays, at least 16, look for
/// a shadow first: stratified samples of one err by n^-3/4 / 2.
double visible_exchange_area(const FacetCaster& caster, const Facet& a, const Facet& b,
                             std::uint64_t key, double S, double tolerance,
                             MethodCounters& counters);

}  // namespace exitance
