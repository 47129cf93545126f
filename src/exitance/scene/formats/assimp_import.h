// SPDX-License-Identifier: Apache-2.0
// Files through Assimp, as they are. Not safe against hostile files: to be called within
// contained_call().
#pragma once

#include <filesystem>
#include <string>

#include "exitance/scene/formats/imported_scene.h"
#include "exitance/scene/read_options.h"

namespace exitance {

/// Reads `bytes` of `path` with Assimp's importer for `extension` (".obj" …), and with no other.
/// Further files are read from the scene's folder alone. Throws std::runtime_error with the
/// importer's message.
ImportedScene assimp_import(const std::filesystem::path& path, const std::string& extension,
                            const std::string& bytes, const ReadOptions& options);

}  // namespace exitance
