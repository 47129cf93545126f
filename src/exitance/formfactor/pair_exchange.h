// SPDX-License-Identifier: Apache-2.0
// Exchange area of one pair of facets, given which blockers may stand between them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "exitance/formfactor/far_exchange.h"
#include "exitance/formfactor/pairwise.h"
#include "exitance/formfactor/partial_exchange.h"

namespace exitance {

/// Two facets of which one hides perhaps a part of the other's view.
struct Pair {
    const SampledFacet *a = nullptr, *b = nullptr;
    bool wholly = true;                      ///< neither cuts the other's plane
    double by_points = 0;                    ///< exchange area as in FarExchange
    double distance = 0;                     ///< as there
    std::uint32_t facet_a = 0, facet_b = 0;  ///< their numbers, for PairSampler
};

/// Casts rays between two facets: what is seen of an exchange area `free`, to a standard error of
/// `tolerance`.
using PairSampler = std::function<double(const Pair&, double free, double tolerance)>;

/// Keeps its working memory from pair to pair; one for each thread.
class PairExchanger {
  public:
    PairExchanger(double accuracy, double slack, PairSampler sampler);

    /// What both see of each other with nothing between.
    double free(const Pair& pair);
    /// With `blockers` perhaps between; to `tolerance`.
    double seen(const Pair& pair, std::span<const Blocker* const> blockers, double tolerance);

    PairwiseCounters counters;

  private:
    double accuracy_, slack_, far_;
    PairSampler sampler_;
    PartialExchanger partial_;
    std::vector<Blocker> cut_;
    std::vector<std::vector<std::uint32_t>> rims_;
    std::vector<std::uint32_t> back_rims_;
    std::vector<Obstacle> obstacles_;
};

}  // namespace exitance
