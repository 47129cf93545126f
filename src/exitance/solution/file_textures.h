// SPDX-License-Identifier: Apache-2.0
// The textures of a solution in its file, in both directions: PNG images in the binary chunk.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/solution/file_extras.h"

namespace exitance::solution_file {

/// The distinct textures of a solution's materials, encoded.
class TexturesOut {
  public:
    explicit TexturesOut(const Solution& solution);

    const std::vector<std::string>& images() const { return images_; }
    /// Number of a texture of the solution.
    std::size_t index(const Texture& texture) const { return index_.at(&texture); }
    /// Adds images (bufferViews from `first_view` on), samplers and textures.
    void describe(nlohmann::json& gltf, std::size_t first_view) const;

  private:
    std::vector<const Texture*> textures_;
    std::map<const Texture*, std::size_t> index_;
    std::vector<std::string> images_;
};

/// Bytes of a bufferView of the file, checked.
using BytesOfView = std::function<std::string_view(const Node& view)>;

/// The pattern of a material, whose texture is `index`; every texture is decoded once.
class TexturesIn {
  public:
    TexturesIn(const Node& root, BytesOfView bytes);

    Pattern pattern(const Node& description, std::size_t bands);

  private:
    std::shared_ptr<const Texture> texture(const Node& index, double most);

    Node root_;
    BytesOfView bytes_;
    std::uint64_t pixels_ = 0;
    std::map<std::pair<std::uint64_t, double>, std::shared_ptr<const Texture>> known_;
};

}  // namespace exitance::solution_file
