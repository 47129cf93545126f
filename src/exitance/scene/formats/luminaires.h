// SPDX-License-Identifier: Apache-2.0
// [[luminaire]] of a lighting project.
#pragma once

#include <string>
#include <vector>

#include "exitance/scene/formats/toml_table.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// The keys that a [[luminaire]] may have.
std::vector<std::string> luminaire_keys();

/// Adds one lamp as a material and a surface of its own. Throws Error(bad_input).
void add_luminaire(Scene& scene, const TomlTable& table);

}  // namespace exitance
