// SPDX-License-Identifier: Apache-2.0
// Lights a scene while pages watch it grow.
#pragma once

#include <filesystem>

#include "exitance/pipeline.h"
#include "exitance/run/progress.h"
#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"
#include "exitance/solve/options.h"
#include "view_server.h"

namespace exitance::cli {

/// What a solve that pages may stop gives.
struct Lit {
    Solution solution;
    bool stopped = false;  ///< by a page, by `interrupt`, or since the last page has closed
};

/// Solves `scene`, shows what there is so far through `server` as `file`, again and again, and at
/// last the solution itself. A page may pause, resume and stop it; so do `interrupt` and, unless
/// `keep`, the closing of the last page stop it. What `snapshots` ask for is done besides.
Lit solve_live(const Scene& scene, const SolveOptions& options, ViewServer& server,
               const std::filesystem::path& file, const Observer& observe, const Cancel& interrupt,
               bool keep, const Snapshots& snapshots, Resumption* resumed = nullptr);

}  // namespace exitance::cli
