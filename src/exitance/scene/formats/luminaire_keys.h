// SPDX-License-Identifier: Apache-2.0
// What the keys of a [[luminaire]] mean for every kind of lamp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/formats/toml_table.h"

namespace exitance {

/// `color` or `color_temperature`, scaled to luminance 1; nothing given: (1, 1, 1).
Spectrum lamp_colour(const TomlTable& table);

/// multiplier × dimming × maintenance.
double lamp_factor(const TomlTable& table);

/// `aim`, or the way to `target`; unit. Nothing given: `otherwise`, or an error without it.
Vec3 lamp_aim(const TomlTable& table, const Vec3& position, const std::optional<Vec3>& otherwise);

/// `columns` × `rows`.
std::uint64_t lamp_count(const TomlTable& table);

/// Places of `columns` × `rows` lamps, `spacing` apart along x and z turned by `array_rotation`,
/// around `position`.
std::vector<Vec3> lamp_positions(const TomlTable& table);

/// Throws Error at the first key of `unused` that is there: "a spot has no 'width'".
void refuse_keys(const TomlTable& table, const std::string& kind,
                 const std::vector<std::string>& unused);

}  // namespace exitance
