// SPDX-License-Identifier: Apache-2.0
// What light from infinity emits into a scene: the part of it that the surfaces take.
#pragma once

#include <cstdint>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Flux of distant light `light` that the mesh receives first hand, for a weight of 1 and weighted
/// by luminance [flux_unit]; what passes glass is counted where it enters it, unless that is a
/// black back. Measured by a ray from each of half a million places spread evenly over all faces,
/// which have nothing to do with the mesh.
double received_flux(const Radiosity& radiosity, std::size_t light, std::uint64_t seed);

}  // namespace exitance
