// SPDX-License-Identifier: Apache-2.0
// Where irradiance is compared with the truth.
#pragma once

#include <string>
#include <vector>

#include "truth/path_tracer.h"

namespace exitance::benchmarks {

struct Place {
    truth::Receiver receiver;
    bool contact = false;  ///< a texel within two of one that is partly covered
};

/// `which`: a number of points, spread evenly over the area of all that reflects, or "texels", the
/// centres of 64 × 64 texels of each such polygon. Points under or inside other objects are left
/// out, and texels of which a part is. Throws Error(wrong_use).
std::vector<Place> find_places(const Scene& scene, const std::string& which);

}  // namespace exitance::benchmarks
