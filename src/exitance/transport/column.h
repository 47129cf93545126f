// SPDX-License-Identifier: Apache-2.0
// One column of the light operator on the fly: what every receiver gets from one source. Nothing is
// stored; a column costs its rays.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

class Obstacles;

enum class PointFactor {
    lambert,  ///< exact factor × sampled visible fraction
    disk      ///< Wallace et al. 1989: the source as discs around sampled places
};

struct ColumnOptions {
    PointFactor factor = PointFactor::lambert;
    bool occlusion = true;
    /// Rays, of those a receiver deserves half at most, that find out whether it lies in a penumbra
    /// at all: what hides less than twice the share of one of them may be missed.
    int most_probes = 64;
    int most_rays = 256;  ///< to a source from one receiver, at most RayBudget::largest
    std::uint64_t seed = 0;
    /// If there: past these the exact factor is seen from flat surfaces, where they are few.
    const Obstacles* obstacles = nullptr;
};

/// Per receiver.
struct ColumnEntry {
    float factor = 0;     ///< form factor receiver → source, unobstructed
    float visible = 1;    ///< the visible share of it; 1 where the factor is 0
    float deviation = 0;  ///< standard deviation to expect of `visible`
    float received() const { return factor * visible; }
};

/// Computes entries[i] of receiver which[i]. `brightness` is the exitance of the source in units of
/// the irradiance error that may remain; it sets how many rays a receiver deserves. `number`
/// decorrelates the samples of different sources. Returns the number of rays cast.
std::uint64_t compute_column(const RayCaster& caster, const Source& source, float brightness,
                             std::uint32_t number, const Receivers& receivers,
                             std::span<const std::uint32_t> which, const ColumnOptions& options,
                             std::span<ColumnEntry> entries);

}  // namespace exitance
