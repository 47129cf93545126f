// SPDX-License-Identifier: Apache-2.0
// Sun and sky of a solution in the JSON of its file, in both directions.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "exitance/solution/file_extras.h"

namespace exitance::solution_file {

/// Adds `distant_lights` to the extras, if there are any.
void add_distant_lights(nlohmann::json& extras, const Solution& solution);

/// Fills Solution::distant; groups and bands are known by then.
void read_distant_lights(const Node& extras, Solution& solution);

}  // namespace exitance::solution_file
