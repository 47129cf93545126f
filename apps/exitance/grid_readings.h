// SPDX-License-Identifier: Apache-2.0
// What the sensors of a solution's grids read, per light group: for the page to sum as it likes.
#pragma once

#include <string>

#include "exitance/solution/solution.h"

namespace exitance::cli {

/// JSON: one array per grid with, row by row and point by point, red, green and blue of each light
/// group at weight 1 [irradiance_unit]. Points on a surface are read off it, those in free space
/// gathered over their hemisphere. Other bands than RGB count as grey of their mean. Null where
/// there are more than 20000 points.
std::string grid_readings(const Solution& solution);

}  // namespace exitance::cli
