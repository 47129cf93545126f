// SPDX-License-Identifier: Apache-2.0
// Scenes put together.
#pragma once

#include "exitance/math/transform.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Luminous efficacy that relates W to lm for white RGB light, as in Radiance [lm/W].
inline constexpr double luminous_efficacy = 179;

/// Adds everything of `part` to `scene`, moved by `placing` (a similarity: turns, moves, one
/// scale). Emission in another quantity becomes the scene's: W and lm by `luminous_efficacy`,
/// numbers without a unit as they are; Scene::warnings tells.
void merge(Scene& scene, Scene part, const Transform& placing);

}  // namespace exitance
