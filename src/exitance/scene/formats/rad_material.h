// SPDX-License-Identifier: Apache-2.0
// Radiance materials as materials of the scene.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "exitance/scene/formats/read_warnings.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Is this the type of a material that scene_material() knows?
bool is_rad_material(std::string_view type);
/// Is this a texture, pattern or mixture: a modifier that is no material?
bool is_rad_pattern(std::string_view type);

/// A material from its type and real arguments; emission is π × radiance [W/m²]. Materials that
/// the format knows and we do not are grey or clear, and told in `warnings`. Throws Error at
/// `place` for arguments that are missing or out of range.
Material rad_material(const std::string& name, std::string_view type, std::span<const double> reals,
                      const Place& place, ReadWarnings& warnings);

}  // namespace exitance
