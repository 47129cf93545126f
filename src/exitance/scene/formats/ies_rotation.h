// SPDX-License-Identifier: Apache-2.0
// Types A and B of LM-63 in the C-planes of type C.
#pragma once

#include <vector>

#include "exitance/scene/formats/c_planes.h"

namespace exitance {

enum class IesType {
    a,  ///< vertical polar axis, (0, 0) looks along the photometric horizontal: vehicle lamps
    b   ///< horizontal polar axis, (0, 0) looks to nadir: floodlights
};

/// Resamples a table over (H, V) [degrees] on C-planes. `columns` have increasing H in their `c`
/// and one value per V of `verticals`; beyond them it is dark. Sets planes, gammas, candela and
/// forward.
void rotate_to_c_planes(Photometry& photometry, IesType type, const std::vector<double>& verticals,
                        const std::vector<CPlane>& columns);

/// The direction (H, V) in the photometric frame.
Vec3 direction_of(IesType type, double h, double v);

}  // namespace exitance
