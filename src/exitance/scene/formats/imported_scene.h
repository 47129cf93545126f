// SPDX-License-Identifier: Apache-2.0
// What a general importer finds in a file, before it is judged; and the same as bytes, to be sent
// from the process that reads the file.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/math/transform.h"

namespace exitance {

struct ImportedMaterial {
    std::string name;
    std::array<double, 3> diffuse{}, emissive{};
    double opacity = 1;
    std::optional<double> refractive_index;
    bool two_sided = false;
    bool diffuse_known = false, diffuse_texture = false, emissive_texture = false;
};

/// Faces of any number of corners.
struct ImportedMesh {
    std::string name;
    std::uint32_t material = 0;
    std::vector<Vec3> positions, normals;     ///< normals: none, or as many as positions
    std::vector<std::uint32_t> face_corners;  ///< how many of `corners` each face has
    std::vector<std::uint32_t> corners;       ///< into positions
};

/// Parents come before their children.
struct ImportedNode {
    std::string name;
    std::optional<std::uint32_t> parent;
    Transform placing;  ///< in the parent
    std::vector<std::uint32_t> meshes;
};

struct ImportedCamera {
    std::string name;  ///< that of its node
    Vec3 position, view{0, 0, 1}, up{0, 1, 0};
    double fov_x = 0;   ///< full angle [radians]
    double aspect = 0;  ///< 0 = not said
    double near = 0, far = 0;
};

struct ImportedLight {
    enum class Kind : std::uint32_t { point, spot, directional, other };
    std::string name;  ///< that of its node
    Kind kind = Kind::other;
    Vec3 position, direction;
    std::array<double, 3> colour{};         ///< with its strength
    double inner_cone = 0, outer_cone = 0;  ///< full angles [radians]
};

struct ImportedScene {
    std::vector<ImportedNode> nodes;
    std::vector<ImportedMesh> meshes;
    std::vector<ImportedMaterial> materials;
    std::vector<ImportedCamera> cameras;
    std::vector<ImportedLight> lights;
    std::vector<std::string> warnings;    ///< of the importer
    std::vector<std::string> missing;     ///< files that were asked for and are not there
    std::string refused;                  ///< a file that must not be read; "" = none
    std::optional<double> unit;           ///< metres per unit, where the importer says so
    std::optional<int> up_axis, up_sign;  ///< 0 … 2 and ±1, where the importer says so
};

std::string pack(const ImportedScene& scene);
/// Throws std::length_error if `bytes` are not what pack() makes.
ImportedScene unpack(std::string_view bytes);

}  // namespace exitance
