// SPDX-License-Identifier: Apache-2.0
// One door for every scene format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

/// Reads any supported scene: AFIT geom (.geom), glTF 2.0 (.gltf, .glb), lighting project (.toml).
/// Throws Error(bad_input) with file:line:column. What was mended is listed in Scene::warnings.
Scene read_scene(const std::filesystem::path& path);

}  // namespace exitance
