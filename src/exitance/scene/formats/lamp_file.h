// SPDX-License-Identifier: Apache-2.0
// One door for photometric files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exitance/scene/photometry.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// What a file says about a luminaire.
struct LampFile {
    Photometry photometry;
    std::string format;           ///< as a reader would call it: "IES LM-63-2002"
    std::uint32_t lamp_sets = 1;  ///< that may be fitted; candelas are for the one asked for
    std::vector<Problem> warnings;
};

/// By its extension, .ies or .ldt, in any case.
bool is_lamp_file(const std::filesystem::path& path);

/// Reads IES LM-63 (.ies) or EULUMDAT (.ldt); `lamp_set` from 1 picks one of the sets of lamps of
/// an EULUMDAT file. Throws Error(bad_input) with file:line:column.
LampFile read_lamp_file(const std::filesystem::path& path, std::uint32_t lamp_set = 1,
                        const ReadOptions& options = {});

}  // namespace exitance
