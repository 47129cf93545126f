// SPDX-License-Identifier: Apache-2.0
// The goniometric diagram of a luminaire.
#pragma once

#include <string>

#include "exitance/scene/photometry.h"

namespace exitance::cli {

/// SVG of the intensities in the planes C0–C180 and C90–C270: nadir below, rings in cd per 1000 lm
/// of the lamps, or in cd if the luminaire was measured as a whole.
std::string polar_diagram(const Photometry& photometry, const std::string& title);

}  // namespace exitance::cli
