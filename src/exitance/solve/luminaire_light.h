// SPDX-License-Identifier: Apache-2.0
// The light of luminaires, which emit without being in the mesh.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/solve/cast_light.h"

namespace exitance {

/// Adds what all luminaires of the scene send to `received`, as cast_light does for a polygon.
std::uint64_t cast_luminaires(const Radiosity& radiosity, const Receivers& receivers,
                              std::span<const std::uint32_t> which, float tolerance,
                              const ColumnOptions& options, Received& received);

}  // namespace exitance
