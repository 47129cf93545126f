// SPDX-License-Identifier: Apache-2.0
// Bytes that a glTF points at besides its buffers: pictures and lamp files, in a bufferView, in the
// text itself (data URI) or in a file beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exitance/scene/formats/json_text.h"

namespace tinygltf {
class Model;
}

namespace exitance {

/// Whether `path` is a regular file in `folder` or below; links count for what they point at.
bool is_file_below(const std::filesystem::path& path, const std::filesystem::path& folder);

/// The file that a URI names, looked up in `folder`; nothing for one that holds its bytes itself.
std::optional<std::filesystem::path> file_of_uri(const std::string& uri,
                                                 const std::filesystem::path& folder);

class GltfResources {
  public:
    /// `path`: of the glTF; nothing outside its folder is opened.
    GltfResources(const std::filesystem::path& path, const tinygltf::Model& model,
                  const JsonText& json, std::uint64_t most_bytes);

    /// What the object at `owner`, with 'uri' or 'bufferView', stands for. Throws Error(bad_input)
    /// if it cannot be had.
    std::string bytes(const JsonNode& owner) const;
    /// The name of the file that a relative 'uri' leads to, else `otherwise`.
    std::string name(const JsonNode& owner, const std::string& otherwise) const;

  private:
    std::filesystem::path folder_;
    const tinygltf::Model& model_;
    const JsonText& json_;
    std::uint64_t most_bytes_;
};

}  // namespace exitance
