// SPDX-License-Identifier: Apache-2.0
// Right-handed orthonormal frame around a unit normal (Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited", JCGT 6(1)).
#pragma once

#include "exitance/math/vector.h"

namespace exitance {

template <class T>
struct BasicFrame {
    Vector3<T> tangent, bitangent, normal;

    explicit BasicFrame(const Vector3<T>& unit_normal) : normal(unit_normal) {
        const T sign = std::copysign(T(1), normal.z);
        const T a = T(-1) / (sign + normal.z);
        const T b = normal.x * normal.y * a;
        tangent = {T(1) + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
        bitangent = {b, sign + normal.y * normal.y * a, -normal.y};
    }

    Vector3<T> to_world(const Vector3<T>& v) const {
        return tangent * v.x + bitangent * v.y + normal * v.z;
    }
};

using Frame = BasicFrame<double>;

}  // namespace exitance
