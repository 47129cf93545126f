// SPDX-License-Identifier: Apache-2.0
// Closed-form scenes of a few plates in the open.
#pragma once

#include <vector>

#include "analytic/scenes.h"

namespace exitance::analytic {

std::vector<Case> plate_cases();

}  // namespace exitance::analytic
