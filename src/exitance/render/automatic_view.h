// SPDX-License-Identifier: Apache-2.0
// Where to stand when nobody says so.
#pragma once

#include "exitance/scene/scene.h"
#include "exitance/solution/surfaces.h"

namespace exitance {

/// A camera that shows the scene: across the room from the inside if it is one, else all of it
/// from outside. `up` need not be of unit length. `surfaces` made with Backs::open.
Camera automatic_view(const Surfaces& surfaces, const Vec3& up);

}  // namespace exitance
