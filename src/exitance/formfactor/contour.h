// SPDX-License-Identifier: Apache-2.0
// Form factors by the double contour integral, evaluated numerically along both outlines (Goral,
// Torrance, Greenberg & Battaile 1984, "Modeling the interaction of light between diffuse
// surfaces", eq. 9, after Sparrow 1963); what is between is found by rays.
#pragma once

#include "exitance/formfactor/method.h"

namespace exitance {

/// A_i F_ij of two convex outlines that lie before each other's front [m²]:
/// (1/2π) ∮∮ ln r dr_i · dr_j, the shortest edge cut into `segments` with four Gauss points, others
/// into as many more as they are longer, at most 1024.
double contour_exchange_area(std::span<const Vec3> a, std::span<const Vec3> b,
                             std::size_t segments);

/// The pair's `segments` are doubled until that changes it by less than the accuracy, up to 32;
/// `samples` sets them.
FormFactorMatrix contour_form_factors(const MethodCall& call);

}  // namespace exitance
