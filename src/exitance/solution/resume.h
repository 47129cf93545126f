// SPDX-License-Identifier: Apache-2.0
// A solve that goes on from a solution: whether it may, and the mesh that it begins with.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/solution/solution.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

/// Throws Error(bad_input) that says what differs unless `kept` is a solution of this very scene
/// with the same light groups.
void require_same_light(const Solution& kept, const Scene& scene,
                        const std::vector<LightGroup>& groups);

/// Gives `kept` what its file says of the scene but light does not depend on: title, weights of
/// groups, named scenes, cameras and grids, as the scene has them now.
void describe_anew(Solution& kept, const Radiosity& radiosity);

/// Divides the elements of `radiosity`, which nothing has lit yet, until none is more than twice as
/// large as what stood in its place when `kept` was made into triangles; patches may have another
/// size than they had then. The mesh does not grow beyond `most_vertices`. Returns the patch of
/// every triangle, invalid where there is none.
std::vector<PatchId> take_over_mesh(Radiosity& radiosity, const Solution& kept,
                                    std::size_t most_vertices = SIZE_MAX);

}  // namespace exitance
