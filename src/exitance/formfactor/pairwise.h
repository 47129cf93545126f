// SPDX-License-Identifier: Apache-2.0
// Exchange areas of all pairs of facets, each to a stated accuracy: what stands between two facets
// is found by shafts, pairs that see each other wholly or not at all are exact, and of the others
// the visible part is integrated (docs/theory/form-factor.md).
#pragma once

#include <cstdint>

#include "exitance/formfactor/enclosure.h"
#include "exitance/formfactor/exchange_areas.h"
#include "exitance/run/progress.h"

namespace exitance {

struct PairwiseOptions {
    /// Aimed at: the mean over rows of Σ_j |error of F_ij| [1e-6 … 0.1].
    double accuracy = 1e-4;
};

struct PairwiseCounters {
    std::uint64_t pairs = 0;      ///< of facets that face each other
    std::uint64_t separated = 0;  ///< pairs without any blocker near them
    std::uint64_t hidden = 0;     ///< behind one convex blocker
    std::uint64_t visible = 0;    ///< after a look at the blockers
    std::uint64_t partial = 0;
    std::uint64_t sampled =
        0;  ///< of these, by rays: so much is between that exact views cost more
    std::uint64_t viewpoints = 0;
    std::uint64_t rays = 0;
    std::uint64_t unreached = 0;  ///< by rays, and not to the accuracy
};

/// Entries that together are less than a tenth of the accuracy of their row are left out where that
/// makes the row sparse. The same bytes for any number of threads. Throws Error(could_not_finish)
/// when cancelled.
ExchangeAreas pairwise_exchange_areas(const Enclosure& enclosure, const PairwiseOptions& options,
                                      const Observer& observer = {}, const Cancel* cancel = nullptr,
                                      PairwiseCounters* counters = nullptr);

}  // namespace exitance
