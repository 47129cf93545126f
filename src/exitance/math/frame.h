// SPDX-License-Identifier: Apache-2.0
// Right-handed orthonormal frame around a unit normal (Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited", JCGT 6(1)).
#pragma once

#include "exitance/math/vector.h"

namespace exitance {

struct Frame {
    Vec3 tangent, bitangent, normal;

    explicit Frame(const Vec3& unit_normal) : normal(unit_normal) {
        const double sign = std::copysign(1.0, normal.z);
        const double a = -1.0 / (sign + normal.z);
        const double b = normal.x * normal.y * a;
        tangent = {1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
        bitangent = {b, sign + normal.y * normal.y * a, -normal.y};
    }

    Vec3 to_world(const Vec3& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
};

}  // namespace exitance
