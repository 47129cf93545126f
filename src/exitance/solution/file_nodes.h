// SPDX-License-Identifier: Apache-2.0
// The nodes of a solution file beside its mesh, as glTF has them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "exitance/solution/solution.h"

namespace exitance::solution_file {

/// Adds cameras, each with a node: they look along −z of theirs.
void describe_cameras(const Solution& solution, nlohmann::json& gltf);

/// Makes a scene of all nodes, turned so that `up` is +y, as viewers of glTF have it.
void stand_upright(const Vec3& up, nlohmann::json& gltf);

}  // namespace exitance::solution_file
