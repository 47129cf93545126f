// SPDX-License-Identifier: Apache-2.0
// View3D's input (.vs3): the polygons of an enclosure whose form factors are asked for.
#pragma once

#include <filesystem>
#include <string_view>

#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// One Surface per surface of the file, in its order; those with subsurfaces as polygons with these
/// cut out. Reflectance = 1 − emissivity. What else the file says is in Scene::form_factors.
/// Throws Error(bad_input) with file:line:column.
Scene parse_view3d(const std::filesystem::path& path, std::string_view text,
                   const ReadOptions& options = {});

}  // namespace exitance
