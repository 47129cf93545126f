// SPDX-License-Identifier: Apache-2.0
// What catalogues print about a luminaire.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "exitance/scene/photometry.h"

namespace exitance {

struct LampFigures {
    double flux = 0;                     ///< that leaves it [lm]
    double downward = 0;                 ///< share of it below the horizontal
    double peak = 0;                     ///< largest intensity [cd]
    double peak_c = 0, peak_gamma = 0;   ///< where that is [degrees]
    std::optional<double> output_ratio;  ///< flux / lamp lumens, if measured against lamps
    std::optional<double> efficacy;      ///< flux / input power [lm/W]
    /// Angle between the outermost directions of the planes C0–C180 and C90–C270 where the
    /// intensity reaches 50 % (beam) or 10 % (field) of that plane's largest, on the side, below or
    /// above the horizontal, where the largest lies [degrees].
    std::array<double, 2> beam{}, field{};
    LampSymmetry symmetry = LampSymmetry::none;  ///< of the table, to 0.1 % of the peak
};

LampFigures figures_of(const Photometry& photometry);

/// Intensities of the half-planes C and C + 180°, over the signed angle t from −180° (zenith, on
/// the side of C + 180°) over 0 (nadir) to 180°, in `steps` steps [cd].
std::vector<double> profile(const Photometry& photometry, double c, std::size_t steps);

}  // namespace exitance
