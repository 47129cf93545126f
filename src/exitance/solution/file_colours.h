// SPDX-License-Identifier: Apache-2.0
// The colours that any viewer of glTF shows the vertices of a solution file in.
#pragma once

#include <cstdint>

#include "exitance/solution/solution.h"

namespace exitance::solution_file {

/// What viewers multiply with the vertex colours; of two, the emission's, which outshines. None:
/// null.
const Pattern* shown_pattern(const Solution& solution, const Material& material);

/// Weighted sum of the groups' exitances as linear RGB; grey where bands are not R, G, B.
Vec3f total_rgb(const Solution& solution, const SolutionPart& part, std::uint32_t vertex);
/// The same where the texture that viewers show is white.
Vec3f brightest_rgb(const Solution& solution, const SolutionPart& part, std::uint32_t vertex);

}  // namespace exitance::solution_file
