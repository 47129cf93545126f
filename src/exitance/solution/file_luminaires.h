// SPDX-License-Identifier: Apache-2.0
// The luminaires of a solution in the JSON of its file, in both directions.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "exitance/solution/file_extras.h"

namespace exitance::solution_file {

/// Adds `photometries` and `luminaires` to the extras, if there are any.
void add_luminaires(nlohmann::json& extras, const Solution& solution);

/// Fills Solution::luminaires; groups and bands are known by then.
void read_luminaires(const Node& extras, Solution& solution);

}  // namespace exitance::solution_file
