// SPDX-License-Identifier: Apache-2.0
// Lights of general geometry formats: point, spot, directional.
#pragma once

#include "exitance/math/transform.h"
#include "exitance/scene/formats/imported_scene.h"
#include "exitance/scene/formats/read_warnings.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Adds `light`, whose node stands at `placing`: a luminaire, or light from infinity. Its strength
/// has no unit in such files; it is taken as intensity, of a directional light as irradiance across
/// its rays, and told in `warnings`, as are lights of other kinds, which are left out.
void add_imported_light(Scene& scene, const ImportedLight& light, const Transform& placing,
                        const Place& place, ReadWarnings& warnings);

}  // namespace exitance
