// SPDX-License-Identifier: Apache-2.0
// Radiance scene descriptions (.rad), docs/formats.md. No command is ever executed.
#pragma once

#include <filesystem>
#include <string>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Reads a scene description from its `text`; files that `!xform` names are looked up beside the
/// file that names them. Radiometric if a material emits, else unitless. What is not read or not
/// solved for is in Scene::warnings. Throws Error(bad_input) for what has no meaning, commands that
/// are not understood, and exceeded limits.
Scene parse_rad(const std::filesystem::path& path, std::string text, const ReadOptions& options);

}  // namespace exitance
