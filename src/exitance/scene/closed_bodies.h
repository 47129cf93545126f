// SPDX-License-Identifier: Apache-2.0
// Bodies whose surface is closed: light that their two-sided faces send inward never comes out.
#pragma once

#include "exitance/scene/scene.h"

namespace exitance {

/// Makes the faces of closed bodies one-sided where their fronts are outside, so that no light is
/// sent into them and what they stand on can be told as covered. A body is a set of polygons that
/// meet along edges, each edge shared by two that run along it in opposite directions; it must not
/// transmit, hold other polygons within its bounding box, or be a room: more than half as long as
/// the scene. Scene::warnings tells of materials that emitted into bodies.
void close_bodies(Scene& scene);

}  // namespace exitance
