// SPDX-License-Identifier: Apache-2.0
// The part of the luminaires' light that the mesh never receives.
#pragma once

#include <cstdint>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Flux, weighted by luminance and group [flux_unit].
struct LuminaireLosses {
    double escaped = 0;  ///< that leaves the scene
    double behind = 0;   ///< that meets black backs
};

/// Measured by rays in proportion to the light along them.
LuminaireLosses luminaire_losses(const Radiosity& radiosity, std::uint64_t seed);

}  // namespace exitance
