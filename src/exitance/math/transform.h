// SPDX-License-Identifier: Apache-2.0
// Affine map of points and normals.
#pragma once

#include "exitance/math/vector.h"

namespace exitance {

struct Transform {
    /// Images of the unit axes, and of the origin.
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};

    Vec3 point(const Vec3& p) const { return origin + x * p.x + y * p.y + z * p.z; }
    Vec3 vector(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
    double determinant() const { return dot(x, cross(y, z)); }
    /// Image of a plane's normal (not unit length): the cofactor matrix, valid for reflections too.
    Vec3 normal(const Vec3& n) const {
        return (cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) *
               (determinant() < 0 ? -1.0 : 1.0);
    }
    /// This map after `first`.
    Transform after(const Transform& first) const {
        return {vector(first.x), vector(first.y), vector(first.z), point(first.origin)};
    }
    static Transform scale(double s) { return {{s, 0, 0}, {0, s, 0}, {0, 0, s}, {}}; }
};

}  // namespace exitance
