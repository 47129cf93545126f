// SPDX-License-Identifier: Apache-2.0
// Where a solve is to be good: what --view and --grid name.
#pragma once

#include "exitance/scene/scene.h"
#include "exitance/solve/importance.h"
#include "exitance/solve/options.h"

namespace exitance {

/// Lines of sight of the camera and places of the sensors that `options` name; empty if they name
/// none. Throws Error(wrong_use) if the scene has no such thing.
Focus focus_of(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
