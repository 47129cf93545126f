// SPDX-License-Identifier: Apache-2.0
// Of two facets, the parts that lie before each other's front: between them the kernel is positive
// everywhere, as contour integrals need it.
#pragma once

#include <vector>

#include "exitance/formfactor/enclosure.h"

namespace exitance {

struct FacingParts {
    std::vector<Vec3> a, b;  ///< convex outlines; empty if nothing of one faces the other
};

FacingParts facing_parts(const Facet& a, const Facet& b);

/// The part of a convex outline where dot(p − origin, normal) ≥ 0.
std::vector<Vec3> clip_outline(std::span<const Vec3> outline, const Vec3& origin,
                               const Vec3& normal);

}  // namespace exitance
