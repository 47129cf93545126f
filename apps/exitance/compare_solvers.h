// SPDX-License-Identifier: Apache-2.0
// The same scene by several solvers and transports, side by side.
#pragma once

#include <string>

#include "exitance/run/progress.h"
#include "exitance/scene/scene.h"
#include "exitance/solve/options.h"

namespace exitance::cli {

/// A table with a row per pair: adaptive shooting, and every solver of elements with every
/// transport, or with `options.transport` alone. The difference is RMS, of irradiance over its
/// mean, from conjugate gradients run until nothing is left to solve. When `cancel` is requested
/// the table ends there.
std::string compare_solvers(const Scene& scene, const SolveOptions& options, const Cancel& cancel);

}  // namespace exitance::cli
