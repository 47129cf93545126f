// SPDX-License-Identifier: Apache-2.0
// The light of sun and sky, from infinity.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/solve/cast_light.h"

namespace exitance {

// Both add to `received` as cast_light does for a polygon. Returns rays cast.

/// Suns and other single directions.
std::uint64_t cast_suns(const Radiosity& radiosity, const Receivers& receivers,
                        std::span<const std::uint32_t> which, float tolerance,
                        const ColumnOptions& options, Received& received);
/// Skies.
std::uint64_t cast_skies(const Radiosity& radiosity, const Receivers& receivers,
                         std::span<const std::uint32_t> which, float tolerance,
                         const ColumnOptions& options, Received& received);

}  // namespace exitance
