// SPDX-License-Identifier: Apache-2.0
// Materials and Geometry Format (.mgf), versions 1 and 2 (docs/formats.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Reads an MGF file from its `text`; files that it includes are looked up beside `path`, which
/// errors name. Photometric if a material emits, else unitless. What the file does against the
/// rules of the format, and what is not solved for, is in Scene::warnings. Throws Error(bad_input)
/// for what has no meaning and for exceeded limits.
Scene parse_mgf(const std::filesystem::path& path, std::string text, const ReadOptions& options);

}  // namespace exitance
