// SPDX-License-Identifier: Apache-2.0
// The tables [site], [sky] and [sun] of a project.
#pragma once

#include <filesystem>

#include "exitance/scene/formats/toml_table.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Adds the sun and the sky that the project asks for to `scene`, whose quantity is decided.
/// `folder`: of the project, for files, which are limited by `options`.
void add_daylight(Scene& scene, const TomlTable& project, const std::filesystem::path& folder,
                  const ReadOptions& options);

}  // namespace exitance
