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

/// A solution to go on from, and what came of it.
struct Resumption {
    Solution from;  ///< moved away if it is what is returned
    enum class Outcome {
        improved,
        kept,       ///< nothing better was found in the time there was
        sufficient  ///< it had the error asked for
    };
    Outcome outcome = Outcome::improved;
    Ended ended = Ended::converged;  ///< what ended the work, also where `from` is returned
};

/// Lights the scene. `observe` is called from the calling thread between shots; when `cancel` is
/// requested the solution so far is returned. With a `resumption` it begins with the mesh of that
/// solution, which counts as the solution so far. Throws Error for unusable options or scenes, and
/// for a solution of another scene or other light groups.
Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe = {},
               const Cancel* cancel = nullptr, const Snapshots& snapshots = {},
               Resumption* resumption = nullptr);

}  // namespace exitance
