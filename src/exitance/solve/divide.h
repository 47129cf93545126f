// SPDX-License-Identifier: Apache-2.0
// An even mesh, before any light is known.
#pragma once

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Divides every patch into four and four again until no element has an edge longer than
/// `longest_edge` [m].
void divide_evenly(Radiosity& radiosity, double longest_edge);

}  // namespace exitance
