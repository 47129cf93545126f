// SPDX-License-Identifier: Apache-2.0
// Form factors as the mean of the kernel over pairs of random places, each with a ray between them
// (area sampling; Shirley 1991, "Physically based lighting calculations", ch. 5).
#pragma once

#include "exitance/formfactor/method.h"

namespace exitance {

/// A_i F_ij = A_i A_j ⟨V cosθ₁ cosθ₂ / (π r²)⟩. Eight independent batches are doubled until their
/// standard error is below the accuracy, up to 131072 places for each pair of facets; `samples`
/// sets their number. Facets that touch converge slowly: the kernel is not bounded there.
FormFactorMatrix monte_carlo_form_factors(const MethodCall& call);

}  // namespace exitance
