// SPDX-License-Identifier: Apache-2.0
// What a photometric file says that can hardly be meant.
#pragma once

#include <vector>

#include "exitance/scene/photometry.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Doubts about what was read, at `place`: no light at all, more light than its lamps give, another
/// light output ratio than stated, angles γ that leave out a part of a hemisphere.
std::vector<Problem> doubts(const Photometry& photometry, const Place& place);

}  // namespace exitance
