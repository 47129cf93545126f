// SPDX-License-Identifier: Apache-2.0
// glTF 2.0: one mesh, node and primitive per surface; .glb, or .gltf with its bytes inside.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <ostream>

#include "exitance/math/box.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/formats/write_losses.h"
#include "exitance/scene/formats/write_scene.h"

namespace exitance {

namespace {

using nlohmann::json;

constexpr int float_type = 5126, unsigned_int_type = 5125;
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr double pi = std::numbers::pi;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

template <class T>
void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string base64(const std::string& bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three =
                three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
    }
    return out;
}

class GltfWriter {
  public:
    GltfWriter(const Scene& scene, double factor) : scene_(scene), factor_(factor) {
        out_["asset"] = {{"version", "2.0"}, {"generator", "exitance"}};
        out_["scene"] = 0;
        out_["scenes"] = json::array({{{"name", scene.title}}});
        for (const Material& material : scene.materials) write_material(material);
        const auto by_surface = polygons_by_surface(scene);
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            if (!by_surface[s].empty()) write_surface(scene.surfaces[s], by_surface[s]);
        for (const Camera& camera : scene.cameras) write_camera(camera);
        for (std::size_t n = 0; n < nodes_; ++n) out_["scenes"][0]["nodes"].push_back(n);
        if (strong_) out_["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    }

    void write(std::ostream& out, bool binary) {
        if (!bytes_.empty()) {
            out_["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
            if (!binary)
                out_["buffers"][0]["uri"] =
                    "data:application/octet-stream;base64," + base64(bytes_);
        }
        // Names may hold any bytes; what is no UTF-8 is replaced.
        std::string text = out_.dump(binary ? -1 : 1, ' ', false, json::error_handler_t::replace);
        if (!binary) {
            out << text << "\n";
            return;
        }
        while (text.size() % 4 != 0) text += ' ';
        const std::uint64_t all = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
        if (all > std::numeric_limits<std::uint32_t>::max())
            throw Error(Fault::could_not_finish, "the scene is too large for .glb (4 GiB)");
        std::string head = "glTF";
        put(head, std::uint32_t{2});
        put(head, static_cast<std::uint32_t>(all));
        put(head, static_cast<std::uint32_t>(text.size()));
        out << head << "JSON" << text;
        if (bytes_.empty()) return;
        std::string chunk;
        put(chunk, static_cast<std::uint32_t>(bytes_.size()));
        out << chunk << std::string("BIN\0", 4) << bytes_;
    }

  private:
    void write_material(const Material& m) {
        json to = {
            {"name", m.name},
            {"doubleSided", m.two_sided},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {m.reflectance[0], m.reflectance[1], m.reflectance[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}}};
        if (m.emits()) {
            // Luminance L = M / π (Lambert); the factor's bands are at most 1.
            Spectrum l = m.exitance;
            for (double& band : l) band *= factor_ / pi;
            const double strength = std::max(1.0, *std::max_element(l.begin(), l.end()));
            to["emissiveFactor"] = {l[0] / strength, l[1] / strength, l[2] / strength};
            if (strength > 1) {
                to["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
                strong_ = true;
            }
        }
        out_["materials"].push_back(std::move(to));
    }

    std::size_t add_view(std::size_t begin, int target) {
        out_["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", begin},
                                       {"byteLength", bytes_.size() - begin},
                                       {"target", target}});
        return out_["bufferViews"].size() - 1;
    }
    std::size_t add_accessor(std::size_t view, int component, std::size_t count, const char* type) {
        out_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
        return out_["accessors"].size() - 1;
    }
    std::size_t add_vectors(const std::vector<Vec3>& vectors) {
        const std::size_t begin = bytes_.size();
        for (const Vec3& v : vectors)
            for (std::size_t i = 0; i < 3; ++i) put(bytes_, static_cast<float>(v[i]));
        return add_accessor(add_view(begin, array_buffer), float_type, vectors.size(), "VEC3");
    }

    void write_surface(const Surface& surface, const std::vector<const Polygon*>& polygons) {
        bool smooth = false;
        for (const Polygon* polygon : polygons)
            for (const std::uint32_t i : polygon->indices()) smooth |= scene_.normals[i] != Vec3{};
        // Corners without a shading normal are flat: one vertex per polygon, if there are others.
        std::map<std::pair<std::uint32_t, const Polygon*>, std::uint32_t> known;
        std::vector<Vec3> positions, normals;
        std::vector<std::uint32_t> indices;
        const auto vertex = [&](const Polygon* polygon, std::uint32_t corner) {
            const std::uint32_t point = polygon->corners[corner];
            const bool flat = smooth && scene_.normals[point] == Vec3{};
            const auto [entry, fresh] = known.try_emplace(
                {point, flat ? polygon : nullptr}, static_cast<std::uint32_t>(positions.size()));
            if (fresh) {
                positions.push_back(scene_.points[point]);
                if (smooth)
                    normals.push_back(flat ? scene_.normal(*polygon) : scene_.normals[point]);
            }
            return entry->second;
        };
        for (const Polygon* polygon : polygons)
            for (std::uint32_t k = 2; k < polygon->size(); ++k)
                for (const std::uint32_t corner : {0U, k - 1, k})
                    indices.push_back(vertex(polygon, corner));
        const std::size_t begin = bytes_.size();
        for (const std::uint32_t i : indices) put(bytes_, i);
        const std::size_t index_accessor = add_accessor(
            add_view(begin, element_array_buffer), unsigned_int_type, indices.size(), "SCALAR");
        json primitive = {{"indices", index_accessor}, {"material", surface.material}};
        const std::size_t at = add_vectors(positions);
        Box box;
        for (const Vec3& p : positions) box.add(p);
        const auto rounded = [](const Vec3& v) {
            return json::array(
                {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
        };
        out_["accessors"][at]["min"] = rounded(box.lower);
        out_["accessors"][at]["max"] = rounded(box.upper);
        primitive["attributes"]["POSITION"] = at;
        if (smooth) primitive["attributes"]["NORMAL"] = add_vectors(normals);
        out_["meshes"].push_back({{"primitives", json::array({primitive})}});
        out_["nodes"].push_back({{"name", surface.name}, {"mesh", out_["meshes"].size() - 1}});
        ++nodes_;
    }

    // A camera looks along −z of its node, y up (glTF 2.0, section 3.10.2).
    void write_camera(const Camera& camera) {
        json perspective = {{"yfov", camera.fov_y * pi / 180},
                            {"znear", camera.near.value_or(0.01)}};
        if (camera.aspect) perspective["aspectRatio"] = *camera.aspect;
        if (camera.far) perspective["zfar"] = *camera.far;
        out_["cameras"].push_back(
            {{"type", "perspective"}, {"name", camera.name}, {"perspective", perspective}});
        const Vec3 z = normalized(camera.eye - camera.look_at);
        const Vec3 x = normalized(cross(camera.up, z)), y = cross(z, x);
        const Vec3& e = camera.eye;
        out_["nodes"].push_back(
            {{"name", camera.name},
             {"camera", out_["cameras"].size() - 1},
             {"matrix",
              {x.x, x.y, x.z, 0.0, y.x, y.y, y.z, 0.0, z.x, z.y, z.z, 0.0, e.x, e.y, e.z, 1.0}}});
        ++nodes_;
    }

    const Scene& scene_;
    double factor_;
    json out_;
    std::string bytes_;
    std::size_t nodes_ = 0;
    bool strong_ = false;
};

}  // namespace

std::vector<std::string> write_gltf(const Scene& scene, const std::filesystem::path& path) {
    Carries carries;
    carries.quads = false;
    carries.cameras = scene.cameras.size();
    std::vector<std::string> lost = losses(scene, carries);
    const double factor = emission_factor(scene, Quantity::photometric, lost);
    GltfWriter writer(scene, factor);
    const bool binary = lower_extension(path) != ".gltf";
    write_atomically(path, [&](std::ostream& out) { writer.write(out, binary); });
    return lost;
}

}  // namespace exitance
