// SPDX-License-Identifier: Apache-2.0
// Exchange area of one pair of facets, given which blockers may stand between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/formfactor/far_exchange.h"
#include "exitance/formfactor/pairwise.h"
#include "exitance/formfactor/partial_exchange.h"

namespace exitance {

/// Keeps its working memory from pair to pair; one for each thread.
class PairExchanger {
  public:
    PairExchanger(double accuracy, double slack, double total_area);

    /// What both see of each other with nothing between; `by_points` and `distance` as in
    /// FarExchange, `wholly`: neither cuts the other's plane.
    double free(const SampledFacet& a, const SampledFacet& b, bool wholly, double by_points,
                double distance);
    /// With `blockers` perhaps between.
    double seen(const SampledFacet& a, const SampledFacet& b, bool wholly, double by_points,
                double distance, std::span<const Blocker* const> blockers);

    PairwiseCounters counters;

  private:
    double accuracy_, slack_, total_area_, far_;
    PartialExchanger partial_;
    std::vector<Blocker> cut_;
    std::vector<std::vector<std::uint32_t>> rims_;
    std::vector<Obstacle> obstacles_;
};

}  // namespace exitance
