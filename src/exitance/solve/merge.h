// SPDX-License-Identifier: Apache-2.0
// Elements that turned out not to be needed are merged again.
#pragma once

#include <cstddef>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Merges four leaves into their parent wherever the finished irradiance of the vertices between
/// its corners is interpolated within `tolerance` (luminance, summed over the columns'
/// differences). Returns the number of merges.
std::size_t merge_smooth(Radiosity& radiosity, float tolerance);

}  // namespace exitance
