// SPDX-License-Identifier: Apache-2.0
// What receivers get from infinity: the columns of the light operator that belong to sun and sky.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/transport/column.h"
#include "exitance/transport/sky_source.h"

namespace exitance {

/// Computes entries[i] of receiver which[i] (relative to RayCaster::middle()) for a disc: `factor`
/// is its irradiance in the open for a colour of 1. `tolerance`: irradiance that does not matter,
/// for the number of shadow rays, at most 256 per receiver. Returns rays cast.
std::uint64_t compute_sun_column(const RayCaster& caster, const DistantLight& sun, double tolerance,
                                 std::uint32_t number, const Receivers& receivers,
                                 std::span<const std::uint32_t> which, const ColumnOptions& options,
                                 std::span<ColumnEntry> entries);

/// What one receiver gets from the sky, weighted by luminance.
struct SkyEntry {
    float open = 0;      ///< irradiance if nothing were in the way
    float received = 0;  ///< what arrives
    float variance = 0;  ///< of `received`, from sampling visibility
};

/// The same for a sky; `bands` [which × bands of the sky] is the irradiance per band. Each receiver
/// casts four rays into every cell that may bring up to 8 tolerances, and goes on into the
/// quarters of cells that it sees partly until they hardly matter: the edges of windows and roofs.
std::uint64_t compute_sky_column(const RayCaster& caster, const SkySource& sky, double tolerance,
                                 std::uint32_t number, const Receivers& receivers,
                                 std::span<const std::uint32_t> which, const ColumnOptions& options,
                                 std::span<SkyEntry> entries, std::span<float> bands);

}  // namespace exitance
