// SPDX-License-Identifier: Apache-2.0
// Lambert's formula for many receivers at once (see point_polygon.h), in float, without branches.
#pragma once

#include "exitance/visibility/receivers.h"

namespace exitance {

/// `factors[r]` = unobstructed factor from receiver r of the block to the source, to within 1e-4
/// of it or 5e-8, whichever is more. `factors` has room for ReceiverBlock::capacity. Receivers are
/// lifted off their surface by `clearance`, as the rays are that look for what is between: a
/// polygon in the receiver's own plane is below the horizon, whatever rounding says.
void point_polygon_factors(const ReceiverBlock& receivers, const Source& source, float clearance,
                           float* factors);

}  // namespace exitance
