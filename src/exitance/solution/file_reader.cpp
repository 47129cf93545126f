// SPDX-License-Identifier: Apache-2.0
// Reads docs/solution-file.md. The file may be hostile: every index and range is checked, and
// nothing is allocated before the bytes that fill it were seen to exist.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "exitance/solution/file.h"
#include "exitance/solution/file_extras.h"
#include "exitance/solution/file_layout.h"
#include "exitance/solution/file_textures.h"
#include "exitance/solution/glb.h"

namespace exitance {

namespace {

using nlohmann::json;
using namespace solution_file;

/// A range of equally spaced elements inside the BIN chunk.
struct Elements {
    const std::byte* first = nullptr;
    std::size_t stride = 0, count = 0;

    template <class T>
    T at(std::size_t i) const {
        T value;
        std::memcpy(&value, first + i * stride, sizeof value);
        return value;
    }
};

/// The vertices and triangles of one primitive, still as bytes.
struct Primitive {
    Node node;
    std::uint32_t material = 0, group = 0;
    Elements positions, normals, indices;
    std::array<Elements, 2> texture_coordinates{};  ///< if the material is patterned
    std::vector<Elements> exitance, irradiance;
    std::size_t first_vertex = 0;
};

/// A part in the order of the solution.
struct PartPlace {
    const Primitive* primitive = nullptr;
    std::string name;
    std::size_t first = 0, triangles = 0;  ///< within the primitive
};

class Reader {
  public:
    Reader(std::string file, const json& root, const std::vector<std::byte>& binary)
        : file_(std::move(file)), root_(file_, root), binary_(binary) {}

    Solution read() {
        const Node extras = root_["asset"]["extras"]["exitance"];
        read_extras(extras, s_);
        attributes_ = attributes_per_group(s_.bands.size()) * s_.groups.size();
        if (root_.has("materials"))
            for (std::size_t i = 0; i < root_["materials"].size(); ++i)
                read_material_with_patterns(root_["materials"][i]);
        if (root_.has("meshes")) read_mesh();
        if (extras.has("emitters")) read_emitters(extras["emitters"]);
        return std::move(s_);
    }

  private:
    std::string file_;
    Node root_;
    const std::vector<std::byte>& binary_;
    std::size_t attributes_ = 0;
    Solution s_;
    std::vector<Primitive> primitives_;
    TexturesIn textures_{
        root_, [this](const Node& view) {
            const Elements bytes = elements(view, 0, view["byteLength"].count(), 1);
            return std::string_view(reinterpret_cast<const char*>(bytes.first), bytes.count);
        }};

    [[noreturn]] void refuse(const std::string& what) const { throw Error(Place{file_}, what); }

    void read_material_with_patterns(const Node& node) {
        s_.materials.push_back(read_material(node, s_.bands.size()));
        const Node extras = node["extras"]["exitance"];
        for (const auto& [key, pattern] :
             {std::pair{"reflectance_pattern", &Material::reflectance_pattern},
              std::pair{"exitance_pattern", &Material::exitance_pattern}})
            if (extras.has(key))
                s_.materials.back().*pattern = textures_.pattern(extras[key], s_.bands.size());
    }

    /// `count` elements of `size` bytes in a bufferView, `offset` bytes from its start.
    Elements elements(const Node& view, std::uint64_t offset, std::uint64_t count,
                      std::uint64_t size) const {
        view["buffer"].index_below(1);
        const std::uint64_t start = view.has("byteOffset") ? view["byteOffset"].count() : 0;
        const std::uint64_t bytes = view["byteLength"].count();
        if (start > binary_.size() || bytes > binary_.size() - start)
            view.refuse(
                fmt::format("a range within the {} bytes of the BIN chunk", binary_.size()));
        const std::uint64_t stride = view.has("byteStride") ? view["byteStride"].count() : size;
        if (stride < size || stride > 252 + emitter_bytes)
            view.refuse(fmt::format("a byteStride of at least {}", size));
        const bool fits = count == 0 || (offset <= bytes && size <= bytes - offset &&
                                         count - 1 <= (bytes - offset - size) / stride);
        if (!fits) view.refuse(fmt::format("room for {} elements from byte {}", count, offset));
        return {binary_.data() + start + (count ? offset : 0), static_cast<std::size_t>(stride),
                static_cast<std::size_t>(count)};
    }

    Elements accessor(const Node& reference, std::uint64_t component, const char* shape,
                      std::uint64_t size) const {
        const Node accessors = root_["accessors"];
        const Node node = accessors[reference.index_below(accessors.size())];
        if (node["componentType"].count() != component)
            node["componentType"].refuse(fmt::format("{}", component));
        if (node["type"].text() != shape) node["type"].refuse(shape);
        const Node views = root_["bufferViews"];
        return elements(views[node["bufferView"].index_below(views.size())],
                        node.has("byteOffset") ? node["byteOffset"].count() : 0,
                        node["count"].count(), size);
    }

    Elements attribute(const Node& attributes, const std::string& name,
                       std::optional<std::size_t> count = {}) const {
        const Elements out = accessor(attributes[name], 5126, "VEC3", 12);
        if (count && out.count != *count)
            attributes[name].refuse(fmt::format("as many elements as POSITION, {}", *count));
        return out;
    }

    void read_mesh() {
        const Node primitives = root_["meshes"][std::size_t{0}]["primitives"];
        // What the vertices and indices claim to fill; more than there is means accessors overlap,
        // and a small file could demand any amount of memory.
        std::uint64_t claimed = 0;
        std::size_t vertices = 0;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            primitives_.push_back(primitive_at(primitives[p]));
            Primitive& primitive = primitives_.back();
            primitive.first_vertex = vertices;
            vertices += primitive.positions.count;
            claimed += std::uint64_t{primitive.positions.count} * (24 + 12 * attributes_) +
                       std::uint64_t{primitive.indices.count} * 4;
            if (claimed > binary_.size()) refuse("accessors overlap, expected each to be its own");
        }
        if (vertices >= std::numeric_limits<std::uint32_t>::max())
            refuse("more vertices than 32-bit indices reach");
        s_.positions.resize(vertices);
        s_.normals.resize(vertices);
        s_.irradiance = VertexField(vertices, s_.columns());
        for (const Primitive& primitive : primitives_) {
            read_vertices(primitive);
            if (s_.materials[primitive.material].patterned()) read_texture_coordinates(primitive);
        }
        read_parts();
    }

    Primitive primitive_at(const Node& node) const {
        Primitive p{node, 0, 0, {}, {}, {}, {}, {}, {}, 0};
        p.material = static_cast<std::uint32_t>(node["material"].index_below(s_.materials.size()));
        const Node extras = node["extras"]["exitance"];
        p.group = static_cast<std::uint32_t>(extras["group"].index_below(s_.groups.size()));
        const Node attributes = node["attributes"];
        p.positions = attribute(attributes, "POSITION");
        p.normals = attribute(attributes, "NORMAL", p.positions.count);
        for (std::size_t a = 0; a < attributes_; ++a)
            p.exitance.push_back(attribute(attributes, exitance_attribute(a), p.positions.count));
        if (needs_irradiance(s_.materials[p.material]))
            for (std::size_t a = 0; a < attributes_; ++a)
                p.irradiance.push_back(
                    attribute(attributes, irradiance_attribute(a), p.positions.count));
        for (std::size_t i = 0; i < 2 && s_.materials[p.material].patterned(); ++i) {
            const std::string name = fmt::format("TEXCOORD_{}", i);
            p.texture_coordinates[i] = accessor(attributes[name], 5126, "VEC2", 8);
            if (p.texture_coordinates[i].count != p.positions.count)
                attributes[name].refuse(
                    fmt::format("as many elements as POSITION, {}", p.positions.count));
        }
        p.indices = accessor(node["indices"], 5125, "SCALAR", 4);
        return p;
    }

    void read_vertices(const Primitive& p) {
        const Material& material = s_.materials[p.material];
        const std::size_t bands = s_.bands.size(), per_group = attributes_per_group(bands);
        for (std::size_t i = 0; i < p.positions.count; ++i) {
            const std::size_t vertex = p.first_vertex + i;
            const auto position = p.positions.at<Vec3f>(i), normal = p.normals.at<Vec3f>(i);
            if (!is_finite(position)) p.node.refuse(fmt::format("a finite position {}", i));
            if (!(std::abs(length(normal) - 1) < 0.01f))
                p.node.refuse(fmt::format("a unit normal {}", i));
            s_.positions[vertex] = position;
            s_.normals[vertex] = normal;
            const std::span<float> H = s_.irradiance[VertexId(vertex)];
            for (std::size_t a = 0; a < attributes_; ++a) {
                const auto stored = (p.irradiance.empty() ? p.exitance : p.irradiance)[a];
                const auto value = stored.at<Vec3f>(i);
                if (!is_finite(value)) p.node.refuse(fmt::format("finite light at vertex {}", i));
                const std::size_t first = a % per_group * 3;
                for (std::size_t k = 0; k < 3 && first + k < bands; ++k)
                    H[a / per_group * bands + first + k] =
                        p.irradiance.empty()  // H = B / ρ where nothing is emitted
                            ? static_cast<float>(double(value[k]) / material.reflectance[first + k])
                            : value[k];
            }
        }
    }

    void read_texture_coordinates(const Primitive& p) {
        s_.texture_coordinates.resize(s_.positions.size());
        for (std::size_t i = 0; i < p.positions.count; ++i) {
            const auto at = [&](std::size_t set) {
                const auto uv = p.texture_coordinates[set].at<std::array<float, 2>>(i);
                if (!std::isfinite(uv[0]) || !std::isfinite(uv[1]))
                    p.node.refuse(fmt::format("finite texture coordinates at vertex {}", i));
                return TexturePoint{uv[0], uv[1]};
            };
            s_.texture_coordinates[p.first_vertex + i] = {at(0), at(1)};
        }
    }

    void read_parts() {
        std::vector<PartPlace> places;
        std::size_t parts = 0;
        for (const Primitive& p : primitives_)
            parts += p.node["extras"]["exitance"]["parts"].size();
        places.resize(parts);
        for (const Primitive& p : primitives_) {
            const Node list = p.node["extras"]["exitance"]["parts"];
            std::uint64_t first = 0;
            for (std::size_t i = 0; i < list.size(); ++i) {
                PartPlace& place = places[list[i]["order"].index_below(parts)];
                if (place.primitive) list[i]["order"].refuse("every order once");
                place = {&p, list[i]["name"].text(), first, list[i]["triangles"].count()};
                if (place.triangles > p.indices.count / 3 - first)
                    list[i]["triangles"].refuse("no more triangles than indices");
                first += place.triangles;
            }
            if (3 * first != p.indices.count) list.refuse("parts that cover all triangles");
        }
        for (const PartPlace& place : places) {
            const Primitive& p = *place.primitive;
            s_.parts.push_back({place.name, p.material, p.group,
                                static_cast<std::uint32_t>(s_.triangles.size()),
                                static_cast<std::uint32_t>(place.triangles)});
            for (std::size_t t = place.first; t < place.first + place.triangles; ++t) {
                std::array<std::uint32_t, 3> triangle;
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto index = p.indices.at<std::uint32_t>(3 * t + c);
                    if (index >= p.positions.count)
                        p.node.refuse(
                            fmt::format("indices below {}, not {}", p.positions.count, index));
                    triangle[c] = static_cast<std::uint32_t>(p.first_vertex + index);
                }
                s_.triangles.push_back(triangle);
            }
        }
    }

    void read_emitters(const Node& node) {
        const Node views = root_["bufferViews"];
        const Elements records = elements(views[node["bufferView"].index_below(views.size())], 0,
                                          node["count"].count(), emitter_bytes);
        for (std::size_t i = 0; i < records.count; ++i) {
            struct Record {
                std::array<Vec3, 4> corners;
                std::uint32_t corner_count, part;
            };
            static_assert(sizeof(Record) == emitter_bytes);
            const auto record = records.at<Record>(i);
            bool sound = (record.corner_count == 3 || record.corner_count == 4) &&
                         record.part < s_.parts.size();
            for (const Vec3& corner : record.corners) sound = sound && is_finite(corner);
            if (!sound) node.refuse(fmt::format("3 or 4 finite corners and a part, emitter {}", i));
            s_.emitters.push_back({record.corners, record.corner_count, record.part, {}});
            if (!node.has("exitance")) continue;
            const Node mean = node["exitance"][i];
            if (mean.size() > 0)
                s_.emitters.back().exitance =
                    mean.spectrum(s_.bands.size(), std::numeric_limits<double>::max());
        }
    }
};

json parse_json(const std::string& text, const std::string& file) {
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        throw Error(Place{file}, fmt::format("the JSON chunk is broken: {}", error.what()));
    }
}

}  // namespace

Solution read_solution(const std::filesystem::path& path) {
    const GlbChunks chunks = read_glb(path);
    const json root = parse_json(chunks.json, path.string());
    return Reader(path.string(), root, chunks.binary).read();
}

bool is_solution(const std::filesystem::path& path) {
    try {
        const json root = json::parse(read_glb(path, GlbContent::json_only).json);
        return root.is_object() &&
               !root.value("/asset/extras/exitance"_json_pointer, json()).is_null();
    } catch (const Error&) {
        return false;
    } catch (const json::exception&) {
        return false;
    }
}

}  // namespace exitance
