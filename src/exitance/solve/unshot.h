// SPDX-License-Identifier: Apache-2.0
// How much light still waits to be sent on, and where.
#pragma once

#include <vector>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Per vertex of the mesh: luminance of the reflected exitance that has not been shot, ρ H − shot,
/// the mean over the leaves around it by area. Not negative: what was shot too much is no light
/// that waits.
std::vector<float> unshot_at_vertices(const Radiosity& radiosity);

}  // namespace exitance
