// SPDX-License-Identifier: Apache-2.0
// Form factors with polygons replaced by discs, and a ray to the middle of each (Wallace, Elmquist
// & Haines 1989, "A ray tracing algorithm for progressive radiosity", eq. 9).
#pragma once

#include "exitance/formfactor/method.h"

namespace exitance {

/// Both facets are cut into cells; every cell of one receives from a disc for every cell of the
/// other, the one whose cells are larger. `samples` sets the number of cells, to the next square;
/// otherwise their sides are halved until that changes the pair by less than the accuracy, up to
/// 256 cells.
FormFactorMatrix disk_form_factors(const MethodCall& call);

}  // namespace exitance
