// SPDX-License-Identifier: Apache-2.0
// Pictures of all directions on cells of equal solid angle.
#pragma once

#include "exitance/scene/formats/panorama_file.h"
#include "exitance/scene/sky.h"

namespace exitance {

/// The light of an equirectangular picture on cells, each the exact mean of what the pixels send
/// from it: every pixel's radiance times its solid angle is shared among the cells it overlaps.
/// `rotation` degrees turn the picture counter-clockwise seen from above. Cells are no larger than
/// the picture's pixels, from 1.1° (level 7) to 0.28° (level 9).
RadianceMap cells_of(const Panorama& picture, double rotation);

}  // namespace exitance
