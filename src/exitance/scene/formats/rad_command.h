// SPDX-License-Identifier: Apache-2.0
// Commands in Radiance scene descriptions that are understood without executing anything: !xform
// of files, !genbox, !genprism, and these piped into xform.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/formats/similarity_arguments.h"

namespace exitance {

/// xform's options and transformation.
struct RadXform {
    std::string name;                     ///< -n: put before identifiers
    std::optional<std::string> modifier;  ///< -m: of all surfaces
    bool invert = false;                  ///< -I: front becomes back
    SimilarityArguments arguments;
};

struct RadCommand {
    std::vector<std::string> files;    ///< what xform reads; empty = `generated`
    std::string generated;             ///< a scene description that genbox or genprism would print
    std::vector<RadXform> xforms;      ///< the first one is applied first
    std::vector<std::string> ignored;  ///< options that round or bevel
};

/// Understands a command line (without the '!'). Throws Error at `place` for every other command,
/// for options that are not known, and for anything that a shell would act on.
RadCommand understand_rad_command(const std::string& line, const Place& place);

}  // namespace exitance
