// SPDX-License-Identifier: Apache-2.0
// glTF files put together from meshes, textures and lights.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exitance/scene/formats/image_file.h"
#include "formats/gltf_samples.h"

namespace exitance::testing {

using Json = nlohmann::json;
using Rgb = std::array<std::uint8_t, 3>;

/// A picture of `width` × `height` texels, colour by colour from the top left.
inline TexturePicture picture(std::uint32_t width, std::uint32_t height,
                              const std::vector<Rgb>& texels) {
    TexturePicture out{width, height, {}};
    for (const Rgb& texel : texels) out.rgb.insert(out.rgb.end(), texel.begin(), texel.end());
    return out;
}

class GltfBuilder {
  public:
    Json json{{"asset", {{"version", "2.0"}}},
              {"scene", 0},
              {"scenes", {{{"nodes", {0}}}}},
              {"nodes", {{{"mesh", 0}}}}};

    std::size_t view(const std::string& bytes) {
        while (binary_.size() % 4 != 0) binary_ += '\0';
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
        binary_ += bytes;
        return json["bufferViews"].size() - 1;
    }

    template <class T>
    std::size_t accessor(const std::vector<T>& values, int component, const std::string& type,
                         std::size_t count) {
        json["accessors"].push_back({{"bufferView", view(bytes_of(values))},
                                     {"componentType", component},
                                     {"type", type},
                                     {"count", count}});
        return json["accessors"].size() - 1;
    }

    /// Parallelograms from corner a along b and c, facing b × c, (u, v) from 0 to 1 along b and c.
    struct Sheet {
        std::array<float, 3> a, b, c;
    };
    Json& add_sheets(const std::vector<Sheet>& sheets, std::size_t material) {
        std::vector<float> positions, uv;
        std::vector<std::uint32_t> indices;
        for (const Sheet& s : sheets) {
            const auto first = static_cast<std::uint32_t>(uv.size() / 2);
            for (const auto& [p, q] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                for (std::size_t i = 0; i < 3; ++i)
                    positions.push_back(s.a[i] + float(p) * s.b[i] + float(q) * s.c[i]);
                uv.insert(uv.end(), {float(p), float(q)});
            }
            for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
        }
        const std::size_t n = uv.size() / 2;
        Json primitive{{"material", material}};
        primitive["attributes"]["POSITION"] = accessor(positions, 5126, "VEC3", n);
        primitive["attributes"]["TEXCOORD_0"] = accessor(uv, 5126, "VEC2", n);
        primitive["indices"] = accessor(indices, 5125, "SCALAR", indices.size());
        if (!json.contains("meshes")) json["meshes"] = {{{"primitives", Json::array()}}};
        Json& primitives = json["meshes"][0]["primitives"];
        primitives.push_back(primitive);
        return primitives.back();
    }

    /// A texture from the bytes of an image; texels with sharp edges.
    std::size_t add_texture(const std::string& image, Json sampler = {{"magFilter", 9728}}) {
        json["images"].push_back({{"bufferView", view(image)}, {"mimeType", "image/png"}});
        json["samplers"].push_back(std::move(sampler));
        json["textures"].push_back(
            {{"source", json["images"].size() - 1}, {"sampler", json["samplers"].size() - 1}});
        return json["textures"].size() - 1;
    }

    std::size_t add_material(Json material) {
        json["materials"].push_back(std::move(material));
        return json["materials"].size() - 1;
    }

    std::string bytes() const {
        Json whole = json;
        if (!binary_.empty()) {
            Json buffer{{"byteLength", binary_.size()}};
            if (whole.contains("buffers"))
                whole["buffers"][0] = buffer;
            else
                whole["buffers"] = {buffer};
        }
        return glb(whole.dump(), binary_);
    }

  private:
    std::string binary_;
};

inline Json textured(std::size_t texture) {
    return {{"name", "patterned"},
            {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}};
}

}  // namespace exitance::testing
