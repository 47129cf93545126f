// SPDX-License-Identifier: Apache-2.0
// MGF materials as materials of the scene: colours in RGB, energy at most 1.
#pragma once

#include <string>

#include "exitance/scene/formats/mgf_contexts.h"
#include "exitance/scene/formats/read_warnings.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Colours outside RGB become paler at the same luminance; rd + rs + td + ts above 1 is scaled
/// down to 1. Both are told in `warnings`.
Material scene_material(const std::string& name, const MgfMaterial& material,
                        ReadWarnings& warnings);

}  // namespace exitance
