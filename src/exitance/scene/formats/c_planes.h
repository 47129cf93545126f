// SPDX-License-Identifier: Apache-2.0
// Files leave out what symmetry repeats; a Photometry holds the whole round.
#pragma once

#include <vector>

#include "exitance/scene/photometry.h"

namespace exitance {

/// A measured half-plane: C in degrees and one candela value per γ.
struct CPlane {
    double c = 0;
    std::vector<double> candela;
};

/// Fills `photometry.planes` and `candela` from planes with C within 0 … 360 (in any order; the
/// first of equal ones counts), mirrored about the planes that `symmetry` names. One plane, or
/// `rotational`, is the same all round. A circle that is not closed is closed with its first plane.
void set_planes(Photometry& photometry, std::vector<CPlane> planes, LampSymmetry symmetry);

}  // namespace exitance
