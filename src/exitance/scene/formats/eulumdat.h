// SPDX-License-Identifier: Apache-2.0
// EULUMDAT.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "exitance/scene/formats/lamp_file.h"

namespace exitance {

/// `file` is what errors name; `lamp_set` from 1. Throws Error(bad_input) with line and column.
LampFile parse_eulumdat(const std::string& file, std::string_view text, std::uint32_t lamp_set);

}  // namespace exitance
