// SPDX-License-Identifier: Apache-2.0
// The Cornell box as tests and benchmarks use it: the measured geometry and reflectances of the
// Cornell University Program of Computer Graphics with exactly rectangular walls, and the lamp
// 0.1 mm below the ceiling instead of in a hole.
#pragma once

#include "exitance/scene/scene.h"

namespace exitance::truth {

/// In metres, W/m², y up, open at z = 0. Surfaces are named floor, ceiling, back, left, right,
/// short_block, tall_block, lamp; the grids "floor" and "back" have 64 × 64 points.
Scene cornell_box();

}  // namespace exitance::truth
