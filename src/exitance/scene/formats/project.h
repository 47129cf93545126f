// SPDX-License-Identifier: Apache-2.0
// Lighting projects (.toml): geometry files with what they lack (docs/projects.md).
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Reads a scene that a project names at a place; to see that files within files come to an end is
/// left to it.
using ReadGeometry = std::function<Scene(const std::filesystem::path&, const Place&)>;

/// Reads a project from its `text`; files are looked up relative to `path`. Errors made by
/// `read_geometry` pass through. Throws Error(bad_input) with file:line:column.
Scene parse_project(const std::filesystem::path& path, std::string_view text,
                    const ReadGeometry& read_geometry, const ReadOptions& options = {});

}  // namespace exitance
