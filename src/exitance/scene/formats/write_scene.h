// SPDX-License-Identifier: Apache-2.0
// Scenes as files of other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

/// The endings that write_scene() takes: ".glb", ".gltf", ".obj", ".geom", ".mgf", ".rad".
std::vector<std::string> writable_endings();

/// Writes `scene` as the ending of `path` says, whole or not at all; of OBJ also the .mtl, of AFIT
/// geometry also the .display beside it. Turned so that what is up in `scene` is up by the format's
/// convention, if it has one. Returns what the format cannot carry, a sentence each.
/// Throws Error(could_not_finish), Error(wrong_use) for other endings.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path);

/// One format each; the same.
std::vector<std::string> write_gltf(const Scene& scene, const std::filesystem::path& path);
std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path);
std::vector<std::string> write_afit(const Scene& scene, const std::filesystem::path& path);
std::vector<std::string> write_mgf(const Scene& scene, const std::filesystem::path& path);
std::vector<std::string> write_rad(const Scene& scene, const std::filesystem::path& path);

}  // namespace exitance
