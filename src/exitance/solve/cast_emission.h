// SPDX-License-Identifier: Apache-2.0
// The light of everything that emits: lamps among the polygons, luminaires, suns and skies.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/solve/cast_light.h"
#include "exitance/solve/lamps.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

/// Adds the light of `lamps` to `received`, as cast_light does. Returns rays cast.
std::uint64_t cast_lamps(const Radiosity& radiosity, const Lamps& lamps, const Receivers& receivers,
                         std::span<const std::uint32_t> which, float tolerance,
                         const ColumnOptions& options, Received& received);

/// Adds the light of `lamps`, suns and skies to `received`, as cast_light does, and notes which
/// share of the lamps each receiver sees. Returns rays cast.
std::uint64_t cast_emission(const Radiosity& radiosity, const Lamps& lamps,
                            const Receivers& receivers, std::span<const std::uint32_t> which,
                            float tolerance, const ColumnOptions& options, Received& received);

}  // namespace exitance
