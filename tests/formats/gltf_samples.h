// SPDX-License-Identifier: Apache-2.0
// glTF files put together number by number.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace exitance::testing {

/// `values` as little-endian bytes.
template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string out(values.size() * sizeof(T), '\0');
    if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
    return out;
}

inline std::string chunk(const std::string& data, const char* type, char padding) {
    std::string padded = data;
    while (padded.size() % 4 != 0) padded += padding;
    return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(padded.size())}) +
           std::string(type, 4) + padded;
}

inline std::string glb(const std::string& json, const std::string& binary) {
    const std::string chunks =
        chunk(json, "JSON", ' ') + (binary.empty() ? "" : chunk(binary, "BIN\0", '\0'));
    return "glTF" + bytes_of<std::uint32_t>({2, static_cast<std::uint32_t>(12 + chunks.size())}) +
           chunks;
}

/// The unit square in z = 0, facing +z: four positions, four normals, six 16-bit indices, padding.
inline std::string square_binary() {
    return bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
           bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}) +
           bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3, 0, 0});
}

/// A room with one lamp-like square, one camera; buffers as `buffer` (JSON of buffers[0]).
inline std::string square_json(const std::string& buffer) {
    return R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_materials_emissive_strength"],
  "scene": 0,
  "scenes": [{"nodes": [0, 2]}],
  "nodes": [
    {"name": "lamp", "children": [1], "translation": [0, 0, 5]},
    {"mesh": 0, "scale": [2, 3, 1]},
    {"name": "eye", "camera": 0, "translation": [1, 2, 3]}
  ],
  "cameras": [{"type": "perspective", "perspective":
    {"yfov": 0.7853981633974483, "aspectRatio": 1.5, "znear": 0.1}}],
  "materials": [{"name": "glow", "doubleSided": true,
    "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1]},
    "emissiveFactor": [1, 0.5, 0.25],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}}}],
  "meshes": [{"name": "square", "primitives": [
    {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
    {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
    {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}
  ],
  "bufferViews": [
    {"buffer": 0, "byteOffset": 0, "byteLength": 48},
    {"buffer": 0, "byteOffset": 48, "byteLength": 48},
    {"buffer": 0, "byteOffset": 96, "byteLength": 12}
  ],
  "buffers": [)" +
           buffer + "]\n}\n";
}

inline std::string square_glb() {
    return glb(square_json(R"({"byteLength": 112})"), square_binary());
}

inline std::string square_gltf() {
    return square_json(R"({"byteLength": 112, "uri": "square%20data.bin"})");
}

}  // namespace exitance::testing
