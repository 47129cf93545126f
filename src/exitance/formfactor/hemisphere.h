// SPDX-License-Identifier: Apache-2.0
// Form factors by rays spread over the hemisphere with the density of the cosine: the share of rays
// that meet a surface is the factor (Malley 1988, "A shading method for computer generated images";
// Maxwell, Bailey & Goldschmidt 1986).
#pragma once

#include "exitance/formfactor/method.h"

namespace exitance {

/// Place and direction are one 4-dimensional low-discrepancy sequence. Eight independent batches
/// are doubled until the standard error of every factor of a surface is below the accuracy, up to
/// 1048576 rays a facet; `samples` sets the rays of a facet.
FormFactorMatrix hemisphere_form_factors(const MethodCall& call);

}  // namespace exitance
