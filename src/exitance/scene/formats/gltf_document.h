// SPDX-License-Identifier: Apache-2.0
// A glTF file whose every part that the reader uses has been checked: types, ranges, indices, and
// the bytes that accessors point at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/run/error.h"
#include "exitance/scene/formats/json_text.h"

namespace tinygltf {
class Model;
struct Accessor;
}  // namespace tinygltf

namespace exitance {

/// The two parts of a .glb; of a .gltf, all of it is JSON.
struct GltfParts {
    std::string_view json;
    std::string_view binary;
    bool is_binary = false;
};

/// Cuts a file into its chunks. Throws Error(bad_input) if lengths do not add up.
GltfParts split_gltf(const std::string& file, std::string_view bytes);

/// Throws Error(bad_input) at the first value that the reader uses and that does not mean what the
/// specification asks for; after it, every index that the reader follows exists.
void check_gltf(const JsonText& json);

/// The model with its buffers, nothing decoded that the reader does not use (images, animations,
/// skins). Throws Error(bad_input), also for buffers that are missing, shorter than they say or in
/// files larger than `most_bytes`.
tinygltf::Model load_gltf(const std::filesystem::path& path, const GltfParts& parts,
                          const JsonText& json, std::uint64_t most_bytes);

/// Bounds-checked reading of one accessor, sparse ones too.
class GltfAccessor {
  public:
    /// Throws Error(bad_input) if any element lies outside the buffer. `index` exists.
    GltfAccessor(const tinygltf::Model& model, int index, const JsonText& json);

    std::size_t count() const { return count_; }
    int type() const { return type_; }
    int component_type() const { return component_type_; }
    /// The first three components of element `i` of a VEC3 or VEC4, normalised integers as
    /// fractions. i < count().
    Vec3 vec3(std::size_t i) const;
    /// Component `c` of element `i`, which has more than `c`, as above.
    double component(std::size_t i, std::size_t c) const;
    /// Element `i` of an unsigned integer SCALAR. i < count().
    std::uint32_t index(std::size_t i) const;

  private:
    const unsigned char* element(std::size_t i) const;

    struct Replacement {
        std::uint32_t element;
        const unsigned char* bytes;
    };

    const unsigned char* data_ = nullptr;
    std::size_t count_ = 0, stride_ = 0;
    int type_ = 0, component_type_ = 0;
    bool normalised_ = false;
    std::vector<Replacement> sparse_;  ///< sorted by element
};

}  // namespace exitance
