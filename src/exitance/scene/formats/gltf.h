// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (.gltf, .glb) as a scene (docs/formats.md says what is read and what is not).
#pragma once

#include <filesystem>
#include <string_view>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Do these bytes begin like a .glb, or like JSON?
bool looks_like_gltf(std::string_view bytes);

/// Reads a glTF from its bytes; buffers, pictures and lamps in other files are looked up beside
/// `path`, which errors name, and not outside its folder. Photometric if anything emits, else
/// unitless. Throws Error(bad_input).
Scene parse_gltf(const std::filesystem::path& path, std::string_view bytes,
                 const ReadOptions& options = {});
Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace exitance
