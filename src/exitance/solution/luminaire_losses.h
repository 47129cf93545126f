// SPDX-License-Identifier: Apache-2.0
// The part of the luminaires' light that the mesh never receives.
#pragma once

#include <cstdint>

#include "exitance/solution/lost_light.h"

namespace exitance {

/// Flux, weighted by luminance and group [flux_unit]; measured by rays in proportion to the light
/// along them.
LostLight luminaire_losses(const Radiosity& radiosity, std::uint64_t seed);

}  // namespace exitance
