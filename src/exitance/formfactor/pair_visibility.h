// SPDX-License-Identifier: Apache-2.0
// How much of what two facets exchange gets through, by rays between sampled places on both.
#pragma once

#include "exitance/formfactor/facet_caster.h"
#include "exitance/formfactor/method.h"

namespace exitance {

/// Of pairs of places: what is seen and what would be seen with nothing between. The mean over
/// pairs is an exchange area [m²].
struct PairSums {
    double seen = 0, all = 0;
};

/// Casts rays between places begin … end of the 4-dimensional sequence `key`, each lifted off its
/// facet by the caster's clearance. One place is spread evenly over the smaller facet. From there
/// the other is spread over the solid angle of the larger facet if that is near, or else over its
/// area: no pair counts for very much, even where the facets touch.
PairSums sample_pair(const FacetCaster& caster, const Facet& a, const Facet& b, std::uint64_t key,
                     std::uint32_t begin, std::uint32_t end);

/// What gets through of an unobstructed exchange area `S` [m²], wrong by about `tolerance` [m²]:
/// eight independent batches of rays are doubled until their standard error is below. Either what
/// is seen or what is blocked is estimated, whichever varies less. (2 · tolerance / S)^-4/3 / 4
/// rays, at least 16, look for a shadow first: stratified samples of one err by n^-3/4 / 2.
double visible_exchange_area(const FacetCaster& caster, const Facet& a, const Facet& b,
                             std::uint64_t key, double S, double tolerance,
                             MethodCounters& counters);

}  // namespace exitance
