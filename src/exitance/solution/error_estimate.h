// SPDX-License-Identifier: Apache-2.0
// How wrong a solution is, by its own evidence.
#pragma once

#include <cstdint>
#include <optional>

#include "exitance/solution/solution.h"

namespace exitance {

/// RMS error of irradiance (luminance) relative to its mean, from points that the mesh does not
/// know: at each, what the surface says is compared with two independent gathers over the
/// hemisphere. The product of the two differences is free of the gathers' own noise. The mean
/// difference, which every further bounce repeats, is counted 1/(1-ρ) times over. nullopt if no
/// surface receives light. `seed` picks points and rays, of which there are as many as it takes to
/// tell an error like `about` well.
std::optional<ErrorEstimate> estimate_error(const Solution& solution, std::uint64_t seed,
                                            double about);

}  // namespace exitance
