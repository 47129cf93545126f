// SPDX-License-Identifier: Apache-2.0
// How wrong a solution is, by its own evidence.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/solution/solution.h"

namespace exitance {

/// Where errors count and what they bring there, one entry per triangle, as solve/importance.h says
/// of patches.
struct TriangleImportance {
    std::vector<float> shown, weight, echo;
};

/// RMS error of irradiance (luminance) relative to its mean, from points that the mesh does not
/// know: at each, what the surface says is compared with two independent gathers over the
/// hemisphere. The product of the two differences is free of the gathers' own noise. The mean
/// difference, which every further bounce repeats, is counted 1/(1-ρ) times over, and so is the
/// doubt about it. nullopt if no
/// surface receives light. `seed` picks points and rays, of which there are as many as it takes to
/// tell an error like `about` well. With an `importance`, errors count times what is shown of them
/// there, and what others bring there on average is added by their echo instead.
std::optional<ErrorEstimate> estimate_error(const Solution& solution, std::uint64_t seed,
                                            double about,
                                            const TriangleImportance* importance = nullptr);

}  // namespace exitance
