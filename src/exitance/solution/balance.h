// SPDX-License-Identifier: Apache-2.0
// Where the light went.
#pragma once

#include "exitance/solution/solution.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

/// Balance of a solve. What the mesh received is integrated over its vertices; what escaped or met
/// black backs is measured by rays from what was sent out: two independent paths, so their sum is a
/// check on both. `unshot`: flux that was received and not sent on. Luminance-weighted.
EnergyBalance balance(const Radiosity& radiosity, std::uint64_t seed);

}  // namespace exitance
