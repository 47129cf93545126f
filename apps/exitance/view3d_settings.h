// SPDX-License-Identifier: Apache-2.0
// What a View3D file says in its C lines, as options of form-factors.
#pragma once

#include <filesystem>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance::cli {

/// eps, encl, emit, out, list, row and col as accuracy, enforce, interchange, view3d-binary, list,
/// row and col; limits of View3D's recursion have no counterpart. Throws Error(bad_input) for a
/// value that is no number.
std::vector<Setting> view3d_settings(const Scene& scene, const std::filesystem::path& file);

}  // namespace exitance::cli
