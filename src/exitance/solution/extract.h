// SPDX-License-Identifier: Apache-2.0
// From the solver's quadtrees to the solution: a conforming triangulation without T-vertices.
#pragma once

#include <span>
#include <vector>

#include "exitance/solution/solution.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

/// Triangles, vertices and irradiance of the leaves, with parts, materials, emitters, cameras and
/// grids. Every place that any leaf puts on an edge is a vertex of all triangles along that edge.
/// Vertices buried under other objects take the mean of their exposed neighbours. `unshot`, one per
/// vertex of the mesh or empty, becomes Solution::unshot. `patches`, if there, receives the patch
/// of each triangle.
Solution extract_solution(const Radiosity& radiosity, std::span<const float> unshot = {},
                          std::vector<PatchId>* patches = nullptr);

/// 64 bits over geometry and materials, in hexadecimal.
std::string digest(const Scene& scene);

}  // namespace exitance
