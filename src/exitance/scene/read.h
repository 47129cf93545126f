// SPDX-License-Identifier: Apache-2.0
// One door for every scene format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Reads any supported scene: lighting project (.toml), glTF 2.0 (.gltf, .glb), MGF (.mgf),
/// Radiance
/// (.rad), AFIT geom (.geom), View3D (.vs3), .obj, .ply, .stl, .fbx, .dae, .3ds, .ifc. Throws
/// Error(bad_input) with file:line:column. What was mended is listed in Scene::warnings; with
/// `options.strict`, the first of them is thrown.
Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace exitance
