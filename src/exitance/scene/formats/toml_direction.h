// SPDX-License-Identifier: Apache-2.0
// Directions in a project.
#pragma once

#include <cmath>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/toml_table.h"

namespace exitance {

/// `key` as a unit vector, `otherwise` if it is absent; throws Error if that is zero.
inline Vec3 direction(const TomlTable& table, const std::string& key, const Vec3& otherwise) {
    const Vec3 v = table.vector(key).value_or(otherwise);
    if (!(length(v) > limits::length))
        throw Error(table.place(key), key + ": found the zero vector, expected a direction");
    return normalized(v);
}

/// `up` of something that faces `along` (unit); what is not given is y, or −z for what faces up or
/// down. Throws Error if it is along `along`.
inline Vec3 up_beside(const TomlTable& table, const Vec3& along) {
    const Vec3 otherwise = std::abs(along.y) > 0.999 ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
    const Vec3 up = direction(table, "up", otherwise);
    if (length(cross(up, along)) < 1e-6)
        table.refuse("up", "a direction that is not along the line of sight");
    return up;
}

}  // namespace exitance
