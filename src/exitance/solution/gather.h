// SPDX-License-Identifier: Apache-2.0
// Irradiance anywhere in the scene, integrated over the hemisphere (probe --method gather).
#pragma once

#include <cstdint>
#include <span>

#include "exitance/solution/surfaces.h"

namespace exitance {

/// A point in space and the unit normal of the side that receives.
struct GatherPoint {
    Vec3 position, normal;
};

struct GatherOptions {
    /// Over the hemisphere for indirect light, rounded up to packets of 16. 1024: about 0.3 % RMS.
    std::uint32_t hemisphere_rays = 1024;
    /// Per emitter that is partly hidden, at most. 1024: about 0.3 % of its unobstructed light.
    std::uint32_t emitter_rays = 1024;
    std::uint64_t seed = 0;
};

/// Irradiance at each point, `columns` = points × solution columns [irradiance_unit]. Emission
/// comes from Solution::emitters by the exact factor, from its luminaires and from sun and sky,
/// times their visible share; reflected light from rays over the hemisphere that look B − E up
/// where they hit. Backs of one-sided surfaces are black (`surfaces` must be made with
/// Backs::black); glass weakens what it lets through.
void gather(const Surfaces& surfaces, std::span<const GatherPoint> points,
            std::span<double> columns, const GatherOptions& options = {});

}  // namespace exitance
