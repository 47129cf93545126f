// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/obstructed_view.h"

#include <numbers>

#define EXITANCE_LANES_SOURCE "exitance/formfactor/obstructed_view_lanes.h"
#include "exitance/math/instruction_sets.h"

namespace exitance {

void view(const ObstructedTarget& target, const Viewpoints& points, ViewFactors& factors) {
    EXITANCE_LANES_CALL(view)(target, points, factors);
}

}  // namespace exitance
