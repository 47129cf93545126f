// SPDX-License-Identifier: Apache-2.0
// How much of a polygon a point sees, by shadow rays in full packets of 16.
#pragma once

#include <array>
#include <cstdint>

#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// Per receiver of a block: how many rays to cast.
struct RayBudget {
    static constexpr std::uint16_t largest = 1024;
    std::array<std::uint8_t, ReceiverBlock::capacity> probe;  ///< first; 0 = leave it out
    std::array<std::uint16_t, ReceiverBlock::capacity>
        most;  ///< if the probes disagree, ≤ `largest`
};

/// Per receiver of a block. V is what glass lets through, between hidden, 0, and seen, 1.
struct VisibleFractions {
    /// Σ V k / Σ k over the samples, k = cosθ₁ cosθ₂ / r²: the visible part of the factor, which
    /// differs from the visible part of the area where the receiver's horizon cuts the source.
    std::array<float, ReceiverBlock::capacity> fraction;
    /// (1/n) Σ V A cosθ₁ cosθ₂ / (π r² + A/n): Wallace et al. 1989, eq. 9, over the same samples.
    std::array<float, ReceiverBlock::capacity> disk;
    /// Standard deviation to expect of `fraction`: n^-3/4 / 2 for n stratified samples of a source
    /// that is partly hidden, 0 where all samples agreed.
    std::array<float, ReceiverBlock::capacity> deviation;
    std::uint64_t rays = 0;
};

/// Casts `budget.probe` rays per receiver to jittered places of the source, and goes on to
/// `budget.most` where they disagree. Samples are a low-discrepancy sequence scrambled per
/// receiver, stratified in every power-of-two prefix: what hides or shows a whole stratum of the
/// probes is never missed, and smaller slivers bias the fraction by less than a quarter of one
/// probe's share. Without `occlusion` nothing blocks and no ray is cast.
void find_visible_fractions(const RayCaster& caster, const Source& source,
                            const ReceiverBlock& receivers, const RayBudget& budget, bool occlusion,
                            std::uint32_t seed, VisibleFractions& out);

}  // namespace exitance
