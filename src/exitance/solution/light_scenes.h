// SPDX-License-Identifier: Apache-2.0
// Named settings of the light groups: "morning", "presentation".
#pragma once

#include <string>

#include "exitance/solution/solution.h"

namespace exitance {

/// Multiplies the weights of the groups by the factors of the scene called `name`. Throws
/// Error(wrong_use) if the solution has no such scene, or not the groups that it names.
void apply_light_scene(Solution& solution, const std::string& name);

}  // namespace exitance
