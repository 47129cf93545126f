// SPDX-License-Identifier: Apache-2.0
// From a scene to its light.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "exitance/run/progress.h"
#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"
#include "exitance/solve/options.h"

namespace exitance {

/// The solution so far, handed out while the scene is being lit and once when that ends.
struct Snapshots {
    std::optional<std::uint64_t>
        every{};           ///< shots from one to the next; default: none till the end
    bool ambient = false;  ///< with an estimate of what is still unshot
    bool unshot = false;   ///< with Solution::unshot
    std::function<void(Solution)> take{};  ///< called from the calling thread
    /// Asked between shots whether one is wanted now; `every` holds besides.
    std::function<bool(const Progress&)> wanted{};
};

/// Lights the scene. `observe` is called from the calling thread between shots; when `cancel` is
/// requested the solution so far is returned. Throws Error for unusable options or scenes.
Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe = {},
               const Cancel* cancel = nullptr, const Snapshots& snapshots = {});

}  // namespace exitance
