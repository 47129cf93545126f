// SPDX-License-Identifier: Apache-2.0
// The textures of a glTF, decoded when a material first asks for them.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "exitance/scene/formats/gltf_resources.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/texture.h"

namespace tinygltf {
struct TextureInfo;
}

namespace exitance {

/// A texture as a material uses it, and where on it a vertex lies: an affine function of one of
/// its sets of coordinates (KHR_texture_transform).
struct GltfTextureUse {
    std::shared_ptr<const Texture> texture;
    int set = 0;
    std::array<double, 6> transform{1, 0, 0, 0, 1, 0};  ///< rows of u' and v' over (u, v, 1)

    TexturePoint operator()(double u, double v) const;
};

class GltfTextures {
  public:
    using Warn = std::function<void(const std::string& path, const std::string& what)>;

    GltfTextures(const GltfResources& resources, const JsonText& json, const ReadOptions& options,
                 Warn warn);

    /// The texture that `info`, part of the material at `path`, names; linear values above `most`
    /// count as it. Without a texture if there is none or, after a warning, if it cannot be read.
    /// Throws Error(bad_input) beyond `max_texture_pixels`.
    GltfTextureUse use(const tinygltf::TextureInfo& info, double most, const std::string& path);

  private:
    std::shared_ptr<const Texture> texture(std::size_t index, double most);
    TexturePicture picture(const JsonNode& image);

    const GltfResources& resources_;
    const JsonText& json_;
    const ReadOptions& options_;
    Warn warn_;
    std::uint64_t pixels_ = 0;
    std::map<std::pair<std::size_t, double>, std::shared_ptr<const Texture>> known_;
};

}  // namespace exitance
