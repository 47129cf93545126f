// SPDX-License-Identifier: Apache-2.0
// OBJ, PLY, STL, FBX, Collada, 3DS and IFC (docs/formats.md), through an importer that runs in a
// process of its own.
#pragma once

#include <filesystem>
#include <string>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// ".obj", ".ply", ".stl", ".fbx", ".dae", ".3ds" or ".ifc", in any case of letters.
bool is_general_geometry(const std::filesystem::path& path);

/// Reads a file of one of these kinds from its `bytes`; further files (.mtl) from its folder. In
/// metres; the axes are those of the file, unless it says which one is up: then y is. Unitless.
/// Throws Error(bad_input) that names the file.
Scene parse_general_geometry(const std::filesystem::path& path, const std::string& bytes,
                             const ReadOptions& options = {});

}  // namespace exitance
