// SPDX-License-Identifier: Apache-2.0
// IES LM-63: 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "exitance/scene/formats/lamp_file.h"

namespace exitance {

/// A file that TILT= names.
struct TiltFile {
    std::string name, text;
};
using ReadTilt = std::function<TiltFile(const std::string& name)>;

/// `file` is what errors name. Throws Error(bad_input) with line and column.
LampFile parse_ies(const std::string& file, std::string_view text, const ReadTilt& read_tilt);

}  // namespace exitance
