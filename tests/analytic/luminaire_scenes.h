// SPDX-License-Identifier: Apache-2.0
// Closed-form scenes that luminaires light.
#pragma once

#include <vector>

#include "analytic/scenes.h"

namespace exitance::analytic {

std::vector<Case> luminaire_cases();

}  // namespace exitance::analytic
