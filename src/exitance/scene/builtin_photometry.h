// SPDX-License-Identifier: Apache-2.0
// Distributions that need no file.
#pragma once

#include "exitance/scene/photometry.h"

namespace exitance {

/// 1 cd in every direction, from a point.
Photometry isotropic_photometry();

/// 1 cd on the axis, γ = 0, half of it at `beam`/2 and a tenth at `field`/2 from there [degrees],
/// from a point: I = exp(−ln 2 (2γ/beam)^p). 0 < beam < field ≤ 180.
Photometry spot_photometry(double beam, double field);

/// The same distribution seen in a mirror: C runs the other way round.
Photometry mirrored(const Photometry& photometry);

}  // namespace exitance
