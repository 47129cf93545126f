// SPDX-License-Identifier: Apache-2.0
// Writes docs/solution-file.md: lay the bytes out, describe them in JSON, stream them.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "exitance/run/atomic_file.h"
#include "exitance/solution/file.h"
#include "exitance/solution/file_colours.h"
#include "exitance/solution/file_extras.h"
#include "exitance/solution/file_layout.h"
#include "exitance/solution/file_nodes.h"
#include "exitance/solution/file_sink.h"
#include "exitance/solution/file_textures.h"
#include "exitance/solution/glb.h"
#include "exitance/solution/preview.h"

namespace exitance {

namespace {

using nlohmann::json;
using namespace solution_file;

constexpr int float_type = 5126, unsigned_int_type = 5125, unsigned_short_type = 5123;
constexpr int array_buffer = 34962, element_array_buffer = 34963;

/// Parts of one material and one group of emission: a primitive of the mesh.
struct Primitive {
    std::uint32_t material = 0, group = 0;
    bool irradiance = false;
    std::vector<std::uint32_t> parts;
    std::vector<std::uint32_t> vertices;  ///< of the solution, ascending
    std::size_t triangles = 0;
};

/// The bytes of one bufferView, and how its accessors describe them.
struct View {
    std::string name;
    std::uint64_t offset = 0, bytes = 0;
    std::size_t stride = 0;
    int target = 0;
};

void demand_finite(const json& value, const std::string& path) {
    if (value.is_number_float() && !std::isfinite(value.get<double>())) not_finite(path);
    if (value.is_structured())
        for (const auto& [key, entry] : value.items()) demand_finite(entry, path + "." + key);
}

class Writer {
  public:
    explicit Writer(const Solution& solution) : s_(solution), textures_(solution) {
        attributes_ = attributes_per_group(s_.bands.size()) * s_.groups.size();
        group_parts();
        lay_out();
    }

    void write(std::ostream& out) {
        tone_preview();
        write_glb(out, description(), size_, [&](std::ostream& binary) { write_binary(binary); });
    }

  private:
    const Solution& s_;
    TexturesOut textures_;
    std::size_t first_image_ = 0;  ///< its view
    std::size_t attributes_ = 0;   ///< exitance attributes per vertex
    std::vector<Primitive> primitives_;
    std::size_t vertices_ = 0;
    std::vector<View> views_;
    std::uint64_t size_ = 0;
    std::vector<Vec3f> colours_;  ///< of the preview, in the order of the file

    void group_parts() {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> known;
        for (std::uint32_t p = 0; p < s_.parts.size(); ++p) {
            const SolutionPart& part = s_.parts[p];
            const auto [entry, is_new] =
                known.try_emplace({part.material, part.group}, primitives_.size());
            if (is_new) {
                const bool irradiance = needs_irradiance(s_.materials[part.material]);
                primitives_.push_back({part.material, part.group, irradiance, {}, {}, 0});
            }
            primitives_[entry->second].parts.push_back(p);
            primitives_[entry->second].triangles += part.triangles;
        }
        std::vector<std::uint32_t> seen(s_.positions.size(), 0);
        for (std::uint32_t p = 0; p < primitives_.size(); ++p) {
            Primitive& primitive = primitives_[p];
            for_each_corner(primitive, [&](std::uint32_t vertex) {
                if (seen[vertex] == p + 1) return;
                seen[vertex] = p + 1;
                primitive.vertices.push_back(vertex);
            });
            std::sort(primitive.vertices.begin(), primitive.vertices.end());
            vertices_ += primitive.vertices.size();
        }
        // glTF allows no empty primitive.
        std::erase_if(primitives_, [](const Primitive& p) { return p.triangles == 0; });
    }

    template <class Body>
    void for_each_corner(const Primitive& primitive, const Body& body) const {
        for (const std::uint32_t p : primitive.parts)
            for (std::uint32_t t = 0; t < s_.parts[p].triangles; ++t)
                for (const std::uint32_t vertex : s_.triangles[s_.parts[p].first_triangle + t])
                    body(vertex);
    }

    void add_view(const std::string& name, std::uint64_t count, std::size_t stride, int target) {
        views_.push_back({name, size_, count * stride, stride, target});
        size_ += count * stride;
    }

    void lay_out() {
        std::size_t with_irradiance = 0, triangles = 0;
        for (const Primitive& p : primitives_) {
            triangles += p.triangles;
            if (p.irradiance) with_irradiance += p.vertices.size();
        }
        if (!s_.emitters.empty()) add_view("emitters", s_.emitters.size(), emitter_bytes, 0);
        if (primitives_.empty()) return;
        add_view("POSITION", vertices_, 12, array_buffer);
        add_view("NORMAL", vertices_, 12, array_buffer);
        add_view("COLOR_0", vertices_, 8, array_buffer);
        for (std::size_t a = 0; a < attributes_; ++a)
            add_view(exitance_attribute(a), vertices_, 12, array_buffer);
        if (with_irradiance)
            for (std::size_t a = 0; a < attributes_; ++a)
                add_view(irradiance_attribute(a), with_irradiance, 12, array_buffer);
        if (!s_.unshot.empty()) add_view(unshot_attribute, vertices_, 4, array_buffer);
        std::size_t patterned = 0;
        for (const Primitive& p : primitives_)
            if (is_patterned(p)) patterned += p.vertices.size();
        if (patterned > 0) {
            add_view("TEXCOORD_0", patterned, 8, array_buffer);
            add_view("TEXCOORD_1", patterned, 8, array_buffer);
        }
        add_view("indices", triangles, 12, element_array_buffer);
        first_image_ = views_.size();
        for (const std::string& image : textures_.images()) {
            add_view("image", 1, image.size(), 0);
            size_ += (4 - size_ % 4) % 4;  // accessors come first, but other tools may append
        }
    }

    bool is_patterned(const Primitive& p) const {
        return !s_.texture_coordinates.empty() && s_.materials[p.material].patterned();
    }

    /// `value(column)` of the up to three columns that attribute `a` carries, the rest zero.
    template <class Value>
    Vec3f three_of(std::size_t a, const Value& value) const {
        const std::size_t bands = s_.bands.size(), per_group = attributes_per_group(bands);
        const std::size_t group = a / per_group, first = a % per_group * 3;
        Vec3f out;
        for (std::size_t i = 0; i < 3 && first + i < bands; ++i)
            out[i] = value(group * bands + first + i);
        return out;
    }

    Vec3f three_exitances(const Primitive& p, std::uint32_t vertex, std::size_t a) const {
        const SolutionPart& part = s_.parts[p.parts[0]];
        return three_of(a, [&](std::size_t c) { return s_.exitance(vertex, part, c); });
    }

    template <class Body>
    void for_each_vertex(const Body& body) const {
        for (const Primitive& primitive : primitives_)
            for (const std::uint32_t vertex : primitive.vertices) body(primitive, vertex);
    }

    void tone_preview() {
        std::vector<float> area_of_vertex(s_.positions.size(), 0.0f);
        for (const auto& t : s_.triangles) {
            const Vec3f &a = s_.positions[t[0]], &b = s_.positions[t[1]], &c = s_.positions[t[2]];
            const float area = length(cross(b - a, c - a)) / 6;
            for (const std::uint32_t vertex : t) area_of_vertex[vertex] += area;
        }
        std::vector<float> areas;
        colours_.reserve(vertices_), areas.reserve(vertices_);
        for_each_vertex([&](const Primitive& primitive, std::uint32_t vertex) {
            colours_.push_back(total_rgb(s_, s_.parts[primitive.parts[0]], vertex));
            areas.push_back(area_of_vertex[vertex]);
        });
        const PreviewTone tone = preview_tone(colours_, areas);
        std::size_t at = 0;
        for_each_vertex([&](const Primitive& primitive, std::uint32_t vertex) {
            if (is_patterned(primitive))
                colours_[at] = brightest_rgb(s_, s_.parts[primitive.parts[0]], vertex);
            ++at;
        });
        for (Vec3f& colour : colours_) colour = tone(colour);
    }

    json accessor(const std::string& view, std::uint64_t first, std::uint64_t count, int type,
                  const char* shape) const {
        std::size_t index = 0;
        while (views_[index].name != view) ++index;
        const std::uint64_t element = type == unsigned_int_type ? 4 : views_[index].stride;
        json out{{"bufferView", index}, {"count", count}, {"componentType", type}, {"type", shape}};
        if (first) out["byteOffset"] = first * element;
        if (type == unsigned_short_type) out["normalized"] = true;
        return out;
    }

    void describe_mesh(json& gltf) const {
        json& accessors = gltf["accessors"] = json::array();
        json primitives = json::array();
        const auto add = [&](json entry) {
            accessors.push_back(std::move(entry));
            return accessors.size() - 1;
        };
        std::uint64_t vertex = 0, irradiance_vertex = 0, triangle = 0, patterned_vertex = 0;
        for (const Primitive& p : primitives_) {
            const std::uint64_t count = p.vertices.size();
            Vector3<float> low = s_.positions[p.vertices[0]], high = low;
            for (const std::uint32_t v : p.vertices)
                low = min(low, s_.positions[v]), high = max(high, s_.positions[v]);
            json position = accessor("POSITION", vertex, count, float_type, "VEC3");
            position["min"] = {low.x, low.y, low.z};
            position["max"] = {high.x, high.y, high.z};
            json attributes{{"POSITION", add(std::move(position))}};
            attributes["NORMAL"] = add(accessor("NORMAL", vertex, count, float_type, "VEC3"));
            attributes["COLOR_0"] =
                add(accessor("COLOR_0", vertex, count, unsigned_short_type, "VEC4"));
            for (std::size_t a = 0; a < attributes_; ++a) {
                const std::string name = exitance_attribute(a);
                attributes[name] = add(accessor(name, vertex, count, float_type, "VEC3"));
            }
            for (std::size_t a = 0; p.irradiance && a < attributes_; ++a) {
                const std::string name = irradiance_attribute(a);
                attributes[name] =
                    add(accessor(name, irradiance_vertex, count, float_type, "VEC3"));
            }
            if (!s_.unshot.empty())
                attributes[unshot_attribute] =
                    add(accessor(unshot_attribute, vertex, count, float_type, "SCALAR"));
            if (is_patterned(p)) {
                for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"})
                    attributes[name] =
                        add(accessor(name, patterned_vertex, count, float_type, "VEC2"));
                patterned_vertex += count;
            }
            const auto indices = add(
                accessor("indices", 3 * triangle, 3 * p.triangles, unsigned_int_type, "SCALAR"));
            json parts = json::array();
            for (const std::uint32_t i : p.parts)
                parts.push_back({{"name", s_.parts[i].name},
                                 {"order", i},
                                 {"triangles", s_.parts[i].triangles}});
            primitives.push_back(
                {{"attributes", attributes},
                 {"indices", indices},
                 {"material", p.material},
                 {"extras", {{"exitance", {{"group", p.group}, {"parts", parts}}}}}});
            vertex += count, triangle += p.triangles;
            if (p.irradiance) irradiance_vertex += count;
        }
        gltf["meshes"] = {{{"name", "solution"}, {"primitives", primitives}}};
        gltf["nodes"].push_back({{"name", "solution"}, {"mesh", 0}});
    }

    void describe_materials(json& gltf) const {
        for (const Material& material : s_.materials) {
            json entry{{"name", material.name},
                       {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                       {"extensions", {{"KHR_materials_unlit", json::object()}}},
                       {"extras", {{"exitance", extras_of(material)}}}};
            json& extras = entry["extras"]["exitance"];
            const auto number = [&](const Pattern& pattern, const char* key) {
                if (pattern) extras[key]["texture"] = textures_.index(*pattern.texture);
            };
            number(material.reflectance_pattern, "reflectance_pattern");
            number(material.exitance_pattern, "exitance_pattern");
            if (const Pattern* shown = shown_pattern(s_, material))
                entry["pbrMetallicRoughness"]["baseColorTexture"] = {
                    {"index", textures_.index(*shown->texture)},
                    {"texCoord", shown == &material.exitance_pattern ? 1 : 0}};
            gltf["materials"].push_back(std::move(entry));
        }
        if (!textures_.images().empty() && !primitives_.empty())
            textures_.describe(gltf, first_image_);
        if (!s_.materials.empty()) gltf["extensionsUsed"] = {"KHR_materials_unlit"};
    }

    std::string description() const {
        json extras = extras_of(s_);
        if (!s_.emitters.empty())
            extras["emitters"] = {{"bufferView", 0}, {"count", s_.emitters.size()}};
        const auto varies = [](const Emitter& emitter) { return !emitter.exitance.empty(); };
        if (std::any_of(s_.emitters.begin(), s_.emitters.end(), varies))
            for (const Emitter& emitter : s_.emitters)
                extras["emitters"]["exitance"].push_back(emitter.exitance);
        json gltf{{"asset",
                   {{"version", "2.0"},
                    {"generator", "Exitance"},
                    {"extras", {{"exitance", std::move(extras)}}}}}};
        if (!primitives_.empty()) describe_mesh(gltf);
        describe_materials(gltf);
        describe_cameras(s_, gltf);
        stand_upright(s_.up, gltf);
        if (size_) gltf["buffers"] = {{{"byteLength", size_}}};
        for (const View& view : views_) {
            json entry{{"name", view.name}, {"buffer", 0}, {"byteLength", view.bytes}};
            if (view.offset) entry["byteOffset"] = view.offset;
            if (view.target) entry["target"] = view.target;
            if (view.target == array_buffer) entry["byteStride"] = view.stride;
            gltf["bufferViews"].push_back(std::move(entry));
        }
        demand_finite(gltf, "glTF");
        return gltf.dump(-1, ' ', false, json::error_handler_t::replace);
    }

    /// glTF wants unit normals; a vertex of degenerate triangles alone has none, any will do.
    static Vec3f unit(const Vec3f& normal) {
        const float l = length(normal);
        if (l == 0) return {0, 0, 1};
        return std::abs(l - 1) < 1e-5f ? normal : normal / l;
    }

    void write_binary(std::ostream& out) const {
        Sink sink(out);
        for (const Emitter& emitter : s_.emitters) {
            for (std::uint32_t i = 0; i < 4; ++i)
                sink.put(i < emitter.corner_count ? emitter.corners[i] : Vec3{});
            sink.put(emitter.corner_count), sink.put(emitter.part);
        }
        for (const Primitive& p : primitives_)
            for (const std::uint32_t v : p.vertices) sink.put(s_.positions[v]);
        for (const Primitive& p : primitives_)
            for (const std::uint32_t v : p.vertices) sink.put(unit(s_.normals[v]));
        for (const Vec3f& colour : colours_) {
            for (std::size_t i = 0; i < 3; ++i)
                sink.put(static_cast<std::uint16_t>(std::lround(colour[i] * 65535.0f)));
            sink.put(std::uint16_t{65535});
        }
        for (std::size_t a = 0; a < attributes_; ++a)
            for_each_vertex([&](const Primitive& p, std::uint32_t vertex) {
                sink.put(three_exitances(p, vertex, a));
            });
        for (std::size_t a = 0; a < attributes_; ++a)
            for_each_vertex([&](const Primitive& p, std::uint32_t vertex) {
                const auto H = s_.irradiance[VertexId(vertex)];
                if (p.irradiance) sink.put(three_of(a, [&](std::size_t c) { return H[c]; }));
            });
        if (!s_.unshot.empty())
            for_each_vertex(
                [&](const Primitive&, std::uint32_t vertex) { sink.put(s_.unshot[vertex]); });
        for (const auto which : {&TextureCoordinates::reflectance, &TextureCoordinates::exitance})
            for_each_vertex([&](const Primitive& p, std::uint32_t vertex) {
                if (!is_patterned(p)) return;
                const TexturePoint& at = s_.texture_coordinates[vertex].*which;
                sink.put(at.u), sink.put(at.v);
            });
        write_indices(sink);
    }

    void write_indices(Sink& sink) const {
        std::vector<std::uint32_t> local(s_.positions.size(), 0);
        for (const Primitive& p : primitives_) {
            for (std::uint32_t i = 0; i < p.vertices.size(); ++i) local[p.vertices[i]] = i;
            for_each_corner(p, [&](std::uint32_t vertex) { sink.put(local[vertex]); });
        }
        std::uint64_t written = 0;
        for (const std::string& image : textures_.images()) {
            for (const char byte : image) sink.put(byte);
            written += image.size();
            for (; written % 4 != 0; ++written) sink.put('\0');
        }
    }
};

}  // namespace

void write_solution(const Solution& solution, const std::filesystem::path& path) {
    Writer writer(solution);
    write_atomically(path, [&](std::ostream& out) { writer.write(out); });
}

}  // namespace exitance
