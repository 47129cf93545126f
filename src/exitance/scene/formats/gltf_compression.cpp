// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_compression.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

namespace exitance {

namespace {

constexpr std::size_t longest = std::numeric_limits<std::int32_t>::max();
// The codecs of meshoptimizer spend at least two bits on sixteen bytes.
constexpr std::size_t best_meshopt_ratio = 64;
// Draco's entropy coding has no such bound; a face or point in an eighth of a byte is beyond what
// real meshes reach.
constexpr std::size_t most_draco_elements_per_byte = 8;

JsonNode extension(const JsonNode& object, const std::string& name) {
    const JsonNode extensions = object.member("extensions");
    return extensions ? extensions.member(name) : extensions;
}

std::size_t whole(const JsonNode& object, const char* key, std::size_t most) {
    return object.required(key).whole(0, most, fmt::format("a whole number up to {}", most));
}

int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes, std::size_t stride) {
    tinygltf::BufferView view;
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteLength = bytes.size();
    view.byteStride = stride;
    tinygltf::Buffer buffer;
    buffer.data = std::move(bytes);
    model.buffers.push_back(std::move(buffer));
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size() - 1);
}

std::vector<unsigned char> bytes_of(const tinygltf::Model& model, std::size_t buffer,
                                    std::size_t offset, std::size_t length, const JsonText& json,
                                    const std::string& path) {
    const std::vector<unsigned char>& all = model.buffers[buffer].data;
    if (offset > all.size() || length > all.size() - offset)
        json.refuse(path, fmt::format("reaches to byte {} of a buffer of {} bytes", offset + length,
                                      all.size()));
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(offset);
    return {first, first + static_cast<std::ptrdiff_t>(length)};
}

void unpack_view(tinygltf::Model& model, std::size_t index, const JsonNode& packed,
                 const JsonText& json) {
    const std::size_t buffer = packed.required("buffer").index(model.buffers.size(), "buffers");
    const JsonNode begin = packed.member("byteOffset");
    const std::size_t offset = begin ? whole(packed, "byteOffset", longest) : 0;
    const std::size_t length = whole(packed, "byteLength", longest);
    const std::size_t stride = whole(packed, "byteStride", 256);
    const std::size_t count = whole(packed, "count", longest);
    const std::string mode = packed.required("mode").string();
    const JsonNode filter_node = packed.member("filter");
    const std::string filter = filter_node ? filter_node.string() : "NONE";
    const bool vertices = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
    if (!vertices && !triangles && mode != "INDICES")
        packed.required("mode").expected("ATTRIBUTES, TRIANGLES or INDICES");
    const bool fits = vertices ? stride >= 4 && stride % 4 == 0 : stride == 2 || stride == 4;
    if (!fits || (triangles && count % 3 != 0) ||
        count * stride > best_meshopt_ratio * length + 65536)
        json.refuse(packed.path, fmt::format("found {} elements of {} bytes in {} bytes, which "
                                             "cannot be",
                                             count, stride, length));
    const auto from = bytes_of(model, buffer, offset, length, json, packed.path);
    std::vector<unsigned char> out(count * stride);
    const int failed =
        vertices ? meshopt_decodeVertexBuffer(out.data(), count, stride, from.data(), from.size())
        : triangles
            ? meshopt_decodeIndexBuffer(out.data(), count, stride, from.data(), from.size())
            : meshopt_decodeIndexSequence(out.data(), count, stride, from.data(), from.size());
    if (failed != 0) json.refuse(packed.path, "its compressed data is damaged");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (filter == "EXPONENTIAL" && vertices)
        meshopt_decodeFilterExp(out.data(), count, stride);
    else if (filter != "NONE")
        filter_node.expected("NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL that fits the stride");
    tinygltf::BufferView& view = model.bufferViews[index];
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteOffset = 0;
    view.byteLength = out.size();
    view.byteStride = vertices ? stride : 0;
    tinygltf::Buffer unpacked;
    unpacked.data = std::move(out);
    model.buffers.push_back(std::move(unpacked));
}

// The values of an attribute, point by point, as floats.
std::vector<unsigned char> values_of(const draco::PointAttribute& attribute, std::size_t points,
                                     std::size_t components, bool normalised) {
    std::vector<unsigned char> out(points * components * sizeof(float));
    double scale = 1;
    if (normalised && !attribute.normalized())
        scale = attribute.data_type() == draco::DT_UINT8    ? 1 / 255.0
                : attribute.data_type() == draco::DT_UINT16 ? 1 / 65535.0
                : attribute.data_type() == draco::DT_INT8   ? 1 / 127.0
                : attribute.data_type() == draco::DT_INT16  ? 1 / 32767.0
                                                            : 1.0;
    for (std::uint32_t p = 0; p < points; ++p) {
        std::array<float, 16> value{};
        attribute.ConvertValue<float>(attribute.mapped_index(draco::PointIndex(p)),
                                      static_cast<std::int8_t>(components), value.data());
        for (std::size_t c = 0; c < components; ++c)
            value[c] = static_cast<float>(scale * double(value[c]));
        std::memcpy(&out[p * components * sizeof(float)], value.data(), components * sizeof(float));
    }
    return out;
}

void put(tinygltf::Model& model, int accessor_index, std::vector<unsigned char> bytes,
         std::size_t count, int component_type) {
    const int view = add_view(model, std::move(bytes), 0);
    tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(accessor_index)];
    accessor.bufferView = view;
    accessor.byteOffset = 0;
    accessor.count = count;
    accessor.componentType = component_type;
    accessor.normalized = false;
    accessor.sparse.isSparse = false;
}

// Points and faces that the data says it has, from its first numbers (Draco bitstream 2.2, sections
// "Header", "Metadata", "Sequential" and "EdgeBreaker" connectivity): the decoder sets memory aside
// on their word. Nothing for data that does not get so far.
std::optional<std::uint64_t> stated_draco_elements(std::span<const unsigned char> from) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(from.data()), from.size());
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return {};
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major,  // NOLINT
                                                         header.version_minor));
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata skipped;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &skipped)) return {};
    }
    std::uint8_t traversal = 0;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING && !buffer.Decode(&traversal))
        return {};
    std::uint32_t first = 0, second = 0;  // faces and points, or points and faces
    if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return {};
    return std::uint64_t{first} + second;
}

bool is_draco_2_2(std::span<const unsigned char> from) {
    static constexpr std::array<unsigned char, 7> begin{'D', 'R', 'A', 'C', 'O', 2, 2};
    return from.size() >= begin.size() && std::equal(begin.begin(), begin.end(), from.begin());
}

void unpack_primitive(tinygltf::Model& model, tinygltf::Primitive& primitive,
                      const JsonNode& packed, const JsonText& json) {
    const std::size_t v =
        packed.required("bufferView").index(model.bufferViews.size(), "bufferViews");
    const tinygltf::BufferView view = model.bufferViews[v];
    const auto from = bytes_of(model, static_cast<std::size_t>(view.buffer), view.byteOffset,
                               view.byteLength, json, packed.path);
    if (!is_draco_2_2(from))
        json.refuse(packed.path, "found other data, expected Draco 2.2, as the extension says");
    const std::uint64_t most = most_draco_elements_per_byte * from.size() + 65536;
    const auto stated = stated_draco_elements(from);
    if (!stated) json.refuse(packed.path, "its Draco data ends in its header");
    if (*stated > most)
        json.refuse(packed.path, fmt::format("found {} points and faces in {} bytes, which cannot "
                                             "be",
                                             *stated, from.size()));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(from.data()), from.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        json.refuse(packed.path, fmt::format("its Draco data cannot be decoded: {}",
                                             decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    const std::size_t points = mesh->num_points(), faces = mesh->num_faces();
    if (points == 0 || faces == 0 || points + faces > most)
        json.refuse(packed.path, fmt::format("found {} points and {} faces in {} bytes", points,
                                             faces, from.size()));
    if (primitive.indices >= 0) {
        std::vector<unsigned char> bytes(faces * 3 * sizeof(std::uint32_t));
        for (std::uint32_t f = 0; f < faces; ++f)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t index = mesh->face(draco::FaceIndex(f))[c].value();
                std::memcpy(&bytes[(3 * f + c) * sizeof index], &index, sizeof index);
            }
        put(model, primitive.indices, std::move(bytes), 3 * faces,
            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
    }
    const JsonNode attributes = packed.required("attributes");
    for (const auto& [name, accessor] : primitive.attributes) {
        const JsonNode id = attributes.member(name);
        if (!id) continue;
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(
            static_cast<std::uint32_t>(id.whole(0, longest, "the number of an attribute")));
        const tinygltf::Accessor& described = model.accessors[static_cast<std::size_t>(accessor)];
        const int components =
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(described.type));
        if (!attribute || components < 1 || components > 16)
            id.expected("the number of an attribute of the Draco data");
        put(model, accessor,
            values_of(*attribute, points, static_cast<std::size_t>(components),
                      described.normalized),
            points, TINYGLTF_COMPONENT_TYPE_FLOAT);
    }
}

}  // namespace

void decompress_gltf(tinygltf::Model& model, const JsonText& json) {
    const JsonNode root{&json, &json.root(), ""};
    const std::size_t views = model.bufferViews.size();
    for (std::size_t i = 0; i < views; ++i)
        if (const JsonNode packed =
                extension(root.required("bufferViews").element(i), "EXT_meshopt_compression"))
            unpack_view(model, i, packed, json);
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
            const JsonNode from =
                root.required("meshes").element(m).required("primitives").element(p);
            const JsonNode packed = extension(from, "KHR_draco_mesh_compression");
            if (!packed) continue;
            tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
            if (const JsonNode indices = from.member("indices"))
                primitive.indices = static_cast<int>(indices.value->get<std::size_t>());
            unpack_primitive(model, primitive, packed, json);
        }
}

}  // namespace exitance
