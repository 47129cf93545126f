// SPDX-License-Identifier: Apache-2.0
// What would spoil a solve, or waste one.
#pragma once

#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

/// Problems of a scene as it is now, each with its place as far as it is known: reflectances of 1
/// and more, coordinates that are no numbers, polygons without area or not planar, faces that are
/// there twice, faces that overlap in one plane and face the same way, nothing that emits,
/// luminaires far away from everything or shining through
/// a surface within 1 mm. Nearly linear in the number of
/// polygons.
std::vector<Problem> validate(const Scene& scene);

}  // namespace exitance
