// SPDX-License-Identifier: Apache-2.0
// Materials of a glTF: how the diffuse part of its reflection model is taken over.
#pragma once

#include "exitance/scene/formats/gltf_textures.h"
#include "exitance/scene/scene.h"

namespace tinygltf {
struct Material;
}

namespace exitance {

/// Reflectance of what the file gives no material, and of textures that cannot be read.
inline constexpr double unknown_reflectance = 0.5;

struct GltfMaterial {
    Material material;
    GltfTextureUse reflectance, exitance;  ///< where its patterns lie
};

/// Material `index` of the file, for vertices of white colour. Throws Error(bad_input).
GltfMaterial read_gltf_material(const tinygltf::Material& from, std::size_t index,
                                GltfTextures& textures, const JsonText& json,
                                const GltfTextures::Warn& warn);

}  // namespace exitance
