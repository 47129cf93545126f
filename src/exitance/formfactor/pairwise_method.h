// SPDX-License-Identifier: Apache-2.0
// The methods that take every pair of polygons by exact integrals.
#pragma once

#include "exitance/formfactor/method.h"

namespace exitance {

/// Shafts, exact contours and the visible part from points (pairwise.h).
FormFactorMatrix pairwise_form_factors(const MethodCall& call);

/// The closed form of each pair of facets (polygon_polygon.h); what is between is found by rays.
FormFactorMatrix analytic_form_factors(const MethodCall& call);

}  // namespace exitance
