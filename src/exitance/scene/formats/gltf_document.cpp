// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_document.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/gltf_compression.h"
#include "exitance/scene/formats/gltf_resources.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

// Little-endian, as all numbers of a glTF.
std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i]))
                 << (8 * i);
    return value;
}

constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

// Sections that the reader does not use; left out before decoding, so that a damaged image does not
// keep a room from being read.
constexpr std::array<const char*, 5> unused_sections{"images", "textures", "samplers", "animations",
                                                     "skins"};

std::string glb_of(const std::string& json, std::string_view binary) {
    std::string out("glTF\2\0\0\0", 8);
    const auto put = [&](std::size_t value) {
        for (unsigned shift = 0; shift < 32; shift += 8)
            out += static_cast<char>((value >> shift) & 0xffU);
    };
    const std::size_t padded = (json.size() + 3) / 4 * 4, rest = (binary.size() + 3) / 4 * 4;
    put(20 + padded + (rest > 0 ? 8 + rest : 0));
    put(padded);
    put(json_chunk);
    out += json + std::string(padded - json.size(), ' ');
    if (rest > 0) {
        put(rest);
        put(binary_chunk);
        out += binary;
        out += std::string(rest - binary.size(), '\0');
    }
    return out;
}

/// Where the files beside a .gltf are, and how large each may be.
struct Beside {
    std::string folder;
    std::uint64_t most_bytes;
};

// Buffers are looked up in the scene's own folder, not in the current one and not outside; only
// regular files are opened, never a pipe or device.
bool is_file(const std::string& path, void* beside) {
    const std::string& scene = static_cast<const Beside*>(beside)->folder;
    return path.rfind(scene, 0) == 0 && is_file_below(path, scene);
}

bool read_file(std::vector<unsigned char>* out, std::string* error, const std::string& path,
               void* beside) {
    try {
        const std::string bytes =
            read_whole_file(path, static_cast<const Beside*>(beside)->most_bytes);
        out->assign(bytes.begin(), bytes.end());
        return true;
    } catch (const Error& failure) {
        *error = failure.what();
        return false;
    }
}

std::string first_line(const std::string& text) {
    std::string line = as_utf8(std::string_view(text).substr(0, text.find('\n')));
    if (line.size() > 200) line = as_utf8(line.substr(0, 200)) + "…";
    return line;
}

// Elements that a file need not hold bytes for; more are no room but an attack on memory.
constexpr std::size_t most_zeros = 1'000'000;

std::size_t component_size(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        default:
            return 4;
    }
}

// The bytes of `count` elements that start at `offset` of a buffer view.
const unsigned char* range(const tinygltf::Model& model, std::size_t view_index, std::size_t offset,
                           std::size_t count, std::size_t stride, std::size_t size,
                           const JsonText& json, const std::string& path) {
    const tinygltf::BufferView& view = model.bufferViews[view_index];
    const std::vector<unsigned char>& bytes =
        model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
        json.refuse(fmt::format("bufferViews[{}]", view_index),
                    fmt::format("reaches to byte {} of a buffer of {} bytes",
                                view.byteOffset + view.byteLength, bytes.size()));
    // offset, count and stride are below 2^32, so nothing overflows.
    const std::size_t end = offset + stride * (count - 1) + size;
    if (end > view.byteLength)
        json.refuse(path, fmt::format("{} elements reach to byte {} of a bufferView of {} bytes",
                                      count, end, view.byteLength));
    return bytes.data() + view.byteOffset + offset;
}

template <class T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

std::uint32_t load_index(const unsigned char* bytes, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *bytes;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

// glTF 2.0, section 3.6.2.2: f = max(c / 127, −1), c / 255, max(c / 32767, −1), c / 65535.
double load_component(const unsigned char* bytes, int type, bool normalised) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const double c = load<std::int8_t>(bytes);
            return normalised ? std::max(c / 127.0, -1.0) : c;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *bytes / (normalised ? 255.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const double c = load<std::int16_t>(bytes);
            return normalised ? std::max(c / 32767.0, -1.0) : c;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes) / (normalised ? 65535.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(bytes);
        default:
            return static_cast<double>(load<float>(bytes));
    }
}

// Draco's triangles have no bytes of their own, which the loader would miss; decompress_gltf()
// brings them back.
void leave_out_draco_indices(nlohmann::json& gltf) {
    if (!gltf.contains("meshes")) return;
    for (nlohmann::json& mesh : gltf["meshes"])
        for (nlohmann::json& primitive : mesh["primitives"])
            if (primitive.contains("extensions") && primitive["extensions"].is_object() &&
                primitive["extensions"].contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
}

// Buffers without bytes, which only readers that know no EXT_meshopt_compression would miss.
void stand_in_for_fallbacks(nlohmann::json& gltf) {
    if (!gltf.contains("buffers")) return;
    for (nlohmann::json& buffer : gltf["buffers"])
        if (!buffer.contains("uri") && buffer.contains("extensions") &&
            buffer["extensions"].is_object() &&
            buffer["extensions"].contains("EXT_meshopt_compression")) {
            buffer["byteLength"] = 1;
            buffer["uri"] = "data:application/octet-stream;base64,AA==";
        }
}

}  // namespace

GltfParts split_gltf(const std::string& file, std::string_view bytes) {
    if (bytes.substr(0, 4) != "glTF") return {bytes, {}, false};
    const auto fail = [&](const std::string& message) { throw Error({file, 0, 0}, message); };
    if (bytes.size() < 20)
        fail(
            fmt::format("found {} bytes, expected at least the 20 of a .glb header", bytes.size()));
    if (word_at(bytes, 4) != 2)
        fail(fmt::format("found glTF version {}, expected 2", word_at(bytes, 4)));
    const std::size_t length = word_at(bytes, 8);
    if (length > bytes.size())
        fail(fmt::format("the file ends after {} of its {} bytes", bytes.size(), length));
    const std::size_t json = word_at(bytes, 12);
    if (word_at(bytes, 16) != json_chunk) fail("the first chunk of the .glb is not JSON");
    if (length < 20 || json > length - 20)
        fail(fmt::format("the JSON chunk of {} bytes reaches beyond the end of the .glb", json));
    GltfParts parts{bytes.substr(20, json), {}, true};
    const std::size_t next = 20 + json;
    if (next + 8 <= length && word_at(bytes, next + 4) == binary_chunk) {
        const std::size_t binary = word_at(bytes, next);
        if (binary > length - next - 8)
            fail(fmt::format("the binary chunk of {} bytes reaches beyond the end of the .glb",
                             binary));
        parts.binary = bytes.substr(next + 8, binary);
    }
    return parts;
}

tinygltf::Model load_gltf(const std::filesystem::path& path, const GltfParts& parts,
                          const JsonText& json, std::uint64_t most_bytes) {
    nlohmann::json used = json.root();
    for (const char* section : unused_sections) used.erase(section);
    stand_in_for_fallbacks(used);
    leave_out_draco_indices(used);
    std::string text = used.dump();
    if (text.size() > 0xf0000000U || parts.binary.size() > 0xf0000000U)
        json.refuse("", "is larger than 4 GB");
    if (!parts.is_binary)
        for (std::size_t i = 0; used.contains("buffers") && i < used["buffers"].size(); ++i)
            if (!used["buffers"][i].contains("uri"))
                json.refuse(fmt::format("buffers[{}]", i), "'uri' is missing");

    // (tinygltf would not tell which.)
    const std::filesystem::path folder = path.parent_path();
    for (std::size_t i = 0; used.contains("buffers") && i < used["buffers"].size(); ++i) {
        const auto& buffer = used["buffers"][i];
        if (!buffer.contains("uri")) continue;
        const std::string uri = buffer["uri"].get<std::string>();
        const auto file = file_of_uri(uri, folder);
        if (!file || is_file_below(*file, folder)) continue;
        std::error_code ignored;
        json.refuse(
            fmt::format("buffers[{}].uri", i),
            std::filesystem::exists(*file, ignored)
                ? fmt::format("found {}, expected a file in the folder of the glTF", in_quotes(uri))
                : fmt::format("there is no file {}", file->string()));
    }

    Beside beside{path.parent_path().empty() ? "." : path.parent_path().string(), most_bytes};
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks({is_file, [](const std::string& name, void*) { return name; }, read_file,
                           [](std::string*, const std::string&, const std::vector<unsigned char>&,
                              void*) { return false; },
                           &beside});
    loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string error, warning;
    bool loaded = false;
    if (parts.is_binary) {
        text = glb_of(text, parts.binary);
        const std::vector<unsigned char> bytes(text.begin(), text.end());
        loaded = loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(),
                                             static_cast<unsigned>(bytes.size()), beside.folder);
    } else {
        loaded = loader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                            static_cast<unsigned>(text.size()), beside.folder);
    }
    if (!loaded || !error.empty())
        json.refuse("", error.empty() ? "cannot be read as glTF" : first_line(error));
    decompress_gltf(model, json);
    return model;
}

GltfAccessor::GltfAccessor(const tinygltf::Model& model, int index, const JsonText& json) {
    const std::string path = fmt::format("accessors[{}]", index);
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
    count_ = accessor.count;
    type_ = accessor.type;
    component_type_ = accessor.componentType;
    normalised_ = accessor.normalized;
    const std::size_t size =
        component_size(component_type_) * static_cast<std::size_t>(tinygltf::GetNumComponentsInType(
                                              static_cast<std::uint32_t>(type_)));
    if (accessor.bufferView >= 0) {
        const auto view = static_cast<std::size_t>(accessor.bufferView);
        const std::size_t given = model.bufferViews[view].byteStride;
        stride_ = given > 0 ? given : size;
        if (stride_ < size)
            json.refuse(
                path, fmt::format("its elements of {} bytes stand {} bytes apart", size, stride_));
        data_ = range(model, view, accessor.byteOffset, count_, stride_, size, json, path);
    } else if (!accessor.sparse.isSparse || count_ > most_zeros) {
        json.refuse(path, accessor.sparse.isSparse
                              ? fmt::format("found {} elements without a bufferView, expected at "
                                            "most {}",
                                            count_, most_zeros)
                              : "has neither a bufferView nor sparse values");
    }
    if (!accessor.sparse.isSparse) return;

    const auto& sparse = accessor.sparse;
    const auto entries = static_cast<std::size_t>(sparse.count);
    const int type = sparse.indices.componentType;
    if (type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_BYTE ||
        type == TINYGLTF_COMPONENT_TYPE_SHORT)
        json.refuse(path + ".sparse.indices", "its indices are not unsigned integers");
    const std::size_t index_size = component_size(type);
    const unsigned char* indices =
        range(model, static_cast<std::size_t>(sparse.indices.bufferView),
              static_cast<std::size_t>(sparse.indices.byteOffset), entries, index_size, index_size,
              json, path + ".sparse.indices");
    const unsigned char* values = range(model, static_cast<std::size_t>(sparse.values.bufferView),
                                        static_cast<std::size_t>(sparse.values.byteOffset), entries,
                                        size, size, json, path + ".sparse.values");
    for (std::size_t i = 0; i < entries; ++i) {
        const std::uint32_t which = load_index(indices + i * index_size, type);
        if (which >= count_ || (i > 0 && which <= sparse_.back().element))
            json.refuse(
                path + ".sparse.indices",
                fmt::format("found the index {}, expected rising indices below {}", which, count_));
        sparse_.push_back({which, values + i * size});
    }
}

const unsigned char* GltfAccessor::element(std::size_t i) const {
    if (!sparse_.empty()) {
        const auto found = std::lower_bound(
            sparse_.begin(), sparse_.end(), i,
            [](const Replacement& r, std::size_t wanted) { return r.element < wanted; });
        if (found != sparse_.end() && found->element == i) return found->bytes;
    }
    // Without a bufferView, elements are zero (glTF 2.0, section 3.6.2.3).
    static constexpr std::array<unsigned char, 64> zero{};
    return data_ ? data_ + i * stride_ : zero.data();
}

double GltfAccessor::component(std::size_t i, std::size_t c) const {
    return load_component(element(i) + c * component_size(component_type_), component_type_,
                          normalised_);
}

Vec3 GltfAccessor::vec3(std::size_t i) const {
    return {component(i, 0), component(i, 1), component(i, 2)};
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
    return load_index(element(i), component_type_);
}

}  // namespace exitance
