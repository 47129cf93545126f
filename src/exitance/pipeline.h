// SPDX-License-Identifier: Apache-2.0
// From a scene to its light.
#pragma once

#include "exitance/run/progress.h"
#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"
#include "exitance/solve/options.h"

namespace exitance {

/// Lights the scene. `observe` is called from the calling thread between shots; when `cancel` is
/// requested the solution so far is returned. Throws Error for unusable options or scenes.
Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe = {},
               const Cancel* cancel = nullptr);

}  // namespace exitance
