// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (.gltf, .glb) as a scene (docs/formats.md says what is read and what is not).
#pragma once

#include <filesystem>
#include <string_view>

#include "exitance/scene/scene.h"

namespace exitance {

/// Do these bytes begin like a .glb, or like JSON?
bool looks_like_gltf(std::string_view bytes);

/// Reads a glTF from its bytes; buffers in other files are looked up beside `path`, which errors
/// name. Photometric if a material emits, else unitless. Throws Error(bad_input).
Scene parse_gltf(const std::filesystem::path& path, std::string_view bytes);
Scene read_gltf(const std::filesystem::path& path);

}  // namespace exitance
