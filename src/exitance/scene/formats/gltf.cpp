// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "exitance/math/transform.h"
#include "exitance/scene/formats/gltf_document.h"
#include "exitance/scene/formats/gltf_lights.h"
#include "exitance/scene/formats/gltf_materials.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/texture_map.h"

namespace exitance {

namespace {

Vec3 vector_of(const std::vector<double>& v, std::size_t first = 0) {
    return {v[first], v[first + 1], v[first + 2]};
}

// Columns of the matrix of a unit quaternion (x, y, z, w).
Transform rotation(const std::vector<double>& q) {
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double x = q[0] / n, y = q[1] / n, z = q[2] / n, w = q[3] / n;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
            {}};
}

// T · R · S, or the matrix, which is stored by columns.
Transform local_transform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16)
        return {vector_of(node.matrix, 0), vector_of(node.matrix, 4), vector_of(node.matrix, 8),
                vector_of(node.matrix, 12)};
    Transform out;
    if (node.rotation.size() == 4) out = rotation(node.rotation);
    if (node.scale.size() == 3) {
        out.x *= node.scale[0];
        out.y *= node.scale[1];
        out.z *= node.scale[2];
    }
    if (node.translation.size() == 3) out.origin = vector_of(node.translation);
    return out;
}

class GltfReader {
  public:
    GltfReader(const std::filesystem::path& path, const tinygltf::Model& model,
               const JsonText& json, const ReadOptions& options)
        : model_(model),
          json_(json),
          options_(options),
          resources_(path, model, json, options.most_bytes()),
          textures_(resources_, json, options, warner()),
          lights_(scene_, resources_, json) {
        scene_.title = path.stem().string();
    }

    Scene read() {
        for (std::size_t i = 0; i < model_.materials.size(); ++i) read_material(i);
        walk();
        summarise();
        average_patterns();
        for (const Material& material : scene_.materials)
            if (material.emits()) scene_.quantity = Quantity::photometric;
        if (!scene_.luminaires.empty() || !scene_.distant.empty())
            scene_.quantity = Quantity::photometric;
        return std::move(scene_);
    }

  private:
    void warn(const std::string& path, const std::string& what) {
        Problem problem;
        problem.place = json_.place(path);
        problem.what = what;
        scene_.warnings.push_back(std::move(problem));
    }

    GltfTextures::Warn warner() {
        return [this](const std::string& path, const std::string& what) { warn(path, what); };
    }

    void read_material(std::size_t index) {
        GltfMaterial read =
            read_gltf_material(model_.materials[index], index, textures_, json_, warner());
        scene_.add_material(std::move(read.material));
        read.material = {};
        uses_.push_back(std::move(read));
    }

    // What is given no material, made when first needed.
    std::uint32_t no_material(const std::string& path) {
        if (!no_material_) {
            Material material;
            material.name = "no material";
            material.reflectance.assign(3, unknown_reflectance);
            material.exitance.assign(3, 0.0);
            material.place = json_.place(path);
            warn(path, fmt::format("there is geometry without a material; its reflectance is taken "
                                   "as {}",
                                   unknown_reflectance));
            no_material_ = scene_.add_material(std::move(material));
        }
        return *no_material_;
    }

    // The nodes of the scene shown by default; without scenes, those that are nobody's children.
    std::vector<int> roots() const {
        if (!model_.scenes.empty())
            return model_.scenes[static_cast<std::size_t>(std::max(model_.defaultScene, 0))].nodes;
        std::vector<bool> child(model_.nodes.size(), false);
        for (const tinygltf::Node& node : model_.nodes)
            for (const int c : node.children) child[static_cast<std::size_t>(c)] = true;
        std::vector<int> out;
        for (std::size_t i = 0; i < child.size(); ++i)
            if (!child[i]) out.push_back(static_cast<int>(i));
        return out;
    }

    void walk() {
        struct Visit {
            int node;
            Transform parent;
        };
        std::vector<bool> seen(model_.nodes.size(), false);
        const std::vector<int> first = roots();
        std::vector<Visit> open;
        for (auto root = first.rbegin(); root != first.rend(); ++root) open.push_back({*root, {}});
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            const auto i = static_cast<std::size_t>(visit.node);
            if (seen[i])
                json_.refuse(fmt::format("nodes[{}]", i),
                             "is reached twice: it has two parents or is its own ancestor");
            seen[i] = true;
            const tinygltf::Node& node = model_.nodes[i];
            const Transform world = visit.parent.after(local_transform(node));
            if (node.mesh >= 0)
                for (const Transform& instance : instances(node, i, world))
                    read_mesh(node, i, instance);
            lights_.add(i, node.name.empty() ? fmt::format("light {}", i) : node.name, world);
            if (node.camera >= 0) read_camera(node, world);
            if (node.skin >= 0) ++skinned_;
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, world});
        }
    }

    void read_mesh(const tinygltf::Node& node, std::size_t node_index, const Transform& world) {
        const auto m = static_cast<std::size_t>(node.mesh);
        const tinygltf::Mesh& mesh = model_.meshes[m];
        const std::string name = !node.name.empty()   ? node.name
                                 : !mesh.name.empty() ? mesh.name
                                                      : fmt::format("node {}", node_index);
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
            read_primitive(mesh.primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p), name,
                           world);
    }

    // EXT_mesh_gpu_instancing: a copy at each translation, rotation and scale, in the node's frame.
    std::vector<Transform> instances(const tinygltf::Node& node, std::size_t node_index,
                                     const Transform& world) const {
        const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
        if (extension == node.extensions.end()) return {world};
        const std::string path =
            fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing", node_index);
        const tinygltf::Value& attributes = extension->second.Get("attributes");
        std::optional<std::size_t> count;
        const auto find = [&](const char* name, int type) {
            std::optional<GltfAccessor> out;
            if (!attributes.Has(name)) return out;
            out.emplace(model_, attributes.Get(name).GetNumberAsInt(), json_);
            if (out->type() != type || (count && *count != out->count()))
                json_.refuse(path + ".attributes." + name,
                             "expected an accessor of the type and count of the extension");
            count = out->count();
            return out;
        };
        const auto moves = find("TRANSLATION", TINYGLTF_TYPE_VEC3);
        const auto turns = find("ROTATION", TINYGLTF_TYPE_VEC4);
        const auto scales = find("SCALE", TINYGLTF_TYPE_VEC3);
        if (count.value_or(1) > options_.max_polygons)
            json_.refuse(path, fmt::format("found {} instances, expected no more than the limit "
                                           "of polygons, {}; --max-polygons raises the limit",
                                           *count, options_.max_polygons));
        std::vector<Transform> out;
        for (std::size_t i = 0; i < count.value_or(1); ++i) {
            tinygltf::Node local;
            const auto list = [](const Vec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
            if (moves) local.translation = list(moves->vec3(i));
            if (scales) local.scale = list(scales->vec3(i));
            if (turns) {
                local.rotation = list(turns->vec3(i));
                local.rotation.push_back(turns->component(i, 3));
                double squared = 0;
                for (const double q : local.rotation) squared += q * q;
                if (!(squared > 0.25 && squared < 4))
                    json_.refuse(path + ".attributes.ROTATION",
                                 fmt::format("rotation {} is no quaternion of length 1", i));
            }
            out.push_back(world.after(local_transform(local)));
        }
        return out;
    }

    std::optional<GltfAccessor> attribute(const tinygltf::Primitive& primitive, const char* name,
                                          const std::string& path,
                                          std::initializer_list<int> types = {TINYGLTF_TYPE_VEC3},
                                          std::optional<std::size_t> count = {}) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        const GltfAccessor accessor(model_, found->second, json_);
        if (std::find(types.begin(), types.end(), accessor.type()) == types.end())
            json_.refuse(path + ".attributes." + name, types.size() > 1 ? "expected a VEC3 or VEC4"
                                                       : *types.begin() == TINYGLTF_TYPE_VEC2
                                                           ? "expected an accessor of type VEC2"
                                                           : "expected an accessor of type VEC3");
        if (count && accessor.count() != *count)
            json_.refuse(path + ".attributes",
                         fmt::format("found {} positions and {} of {}, expected as many", *count,
                                     accessor.count(), name));
        return accessor;
    }

    std::optional<GltfAccessor> indices_of(const tinygltf::Primitive& primitive,
                                           const std::string& path) const {
        std::optional<GltfAccessor> indices;
        if (primitive.indices < 0) return indices;
        indices.emplace(model_, primitive.indices, json_);
        const int type = indices->component_type();
        if (indices->type() != TINYGLTF_TYPE_SCALAR ||
            (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
             type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
             type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
            json_.refuse(path + ".indices", "expected an accessor of unsigned integer scalars");
        return indices;
    }

    /// Where the patterns of a primitive's material lie at its vertices.
    struct Coordinates {
        const GltfTextureUse *reflectance = nullptr, *exitance = nullptr;
        std::array<std::optional<GltfAccessor>, 2> sets{};

        explicit operator bool() const { return reflectance || exitance; }
        TexturePoint of(const GltfTextureUse* use, std::size_t vertex) const {
            if (!use) return {};
            const auto& set = sets[static_cast<std::size_t>(use->set)];
            return set ? (*use)(set->component(vertex, 0), set->component(vertex, 1))
                       : (*use)(0, 0);
        }
        TextureCoordinates operator()(std::size_t vertex) const {
            return {of(reflectance, vertex), of(exitance, vertex)};
        }
    };

    Coordinates coordinates_of(const tinygltf::Primitive& primitive, const std::string& path,
                               std::size_t count) {
        Coordinates out;
        if (primitive.material < 0) return out;
        const GltfMaterial& use = uses_[static_cast<std::size_t>(primitive.material)];
        if (use.reflectance.texture) out.reflectance = &use.reflectance;
        if (use.exitance.texture) out.exitance = &use.exitance;
        for (const GltfTextureUse* one : {out.reflectance, out.exitance}) {
            if (!one) continue;
            const std::string name = fmt::format("TEXCOORD_{}", one->set);
            auto& set = out.sets[static_cast<std::size_t>(one->set)];
            set = attribute(primitive, name.c_str(), path, {TINYGLTF_TYPE_VEC2}, count);
            if (!set) warn(path, fmt::format("{} is missing for its texture", name));
        }
        return out;
    }

    // COLOR_0 multiplies the base colour: here as its mean over the surface.
    void tint(std::uint32_t surface, std::size_t first_polygon, const GltfAccessor& colours,
              const std::vector<std::uint32_t>& vertex_of_point, std::uint32_t first_point) {
        Vec3 sum;
        double area = 0;
        for (std::size_t p = first_polygon; p < scene_.polygons.size(); ++p) {
            const Polygon& polygon = scene_.polygons[p];
            const double weight = scene_.area(polygon) / 3;
            if (!std::isfinite(weight)) continue;
            area += 3 * weight;
            for (const std::uint32_t i : polygon.indices())
                sum += colours.vec3(vertex_of_point[i - first_point]) * weight;
        }
        if (!(area > 0)) return;
        std::array<int, 3> percent{};
        for (std::size_t b = 0; b < 3; ++b)
            percent[b] = static_cast<int>(std::lround(std::clamp(sum[b] / area, 0.0, 1.0) * 1e4));
        if (percent == std::array<int, 3>{10000, 10000, 10000}) return;
        std::uint32_t& material = scene_.surfaces[surface].material;
        const auto [entry, fresh] = tinted_.try_emplace({material, percent}, 0u);
        if (fresh) {
            Material made = scene_.materials[material];
            for (std::size_t b = 0; b < 3; ++b) {
                made.reflectance[b] *= percent[b] / 1e4;
                if (made.reflectance_pattern)
                    made.reflectance_pattern.factor[b] *= percent[b] / 1e4;
                if (!made.transmittance.empty()) made.transmittance[b] *= percent[b] / 1e4;
            }
            entry->second = scene_.add_material(std::move(made));
        }
        material = entry->second;
    }

    // A patterned material's reflectance and exitance become their means over all that it covers.
    void average_patterns() {
        struct Mean {
            double area = 0;
            Spectrum reflectance{0, 0, 0}, exitance{0, 0, 0};
        };
        std::map<std::uint32_t, Mean> means;
        for (const Polygon& polygon : scene_.polygons) {
            const std::uint32_t m = scene_.surfaces[polygon.surface].material;
            if (!scene_.materials[m].patterned()) continue;
            const double area = scene_.area(polygon);
            if (!(area > 0 && std::isfinite(area))) continue;
            Mean& mean = means[m];
            mean.area += area;
            const Spectrum rho = mean_reflectance(scene_, polygon),
                           emitted = mean_exitance(scene_, polygon);
            for (std::size_t b = 0; b < 3; ++b) {
                mean.reflectance[b] += area * rho[b];
                mean.exitance[b] += area * emitted[b];
            }
        }
        for (const auto& [m, mean] : means)
            for (std::size_t b = 0; b < 3; ++b) {
                scene_.materials[m].reflectance[b] = mean.reflectance[b] / mean.area;
                scene_.materials[m].exitance[b] = mean.exitance[b] / mean.area;
            }
    }

    void read_primitive(const tinygltf::Primitive& primitive, const std::string& path,
                        const std::string& name, const Transform& world) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            ++no_triangles_;
            return;
        }
        const auto positions = attribute(primitive, "POSITION", path);
        if (!positions) json_.refuse(path + ".attributes", "'POSITION' is missing");
        const auto normals =
            attribute(primitive, "NORMAL", path, {TINYGLTF_TYPE_VEC3}, positions->count());
        const auto colours =
            attribute(primitive, "COLOR_0", path, {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4},
                      positions->count());
        const Coordinates coordinates = coordinates_of(primitive, path, positions->count());
        const auto indices = indices_of(primitive, path);
        if (!primitive.targets.empty()) ++morphed_;

        const std::uint32_t surface = scene_.add_surface(
            name, primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material)
                                          : no_material(path));
        scene_.surfaces[surface].place = json_.place(path);

        // Vertices are taken over as triangles name them: primitives may share one large accessor.
        std::unordered_map<std::uint32_t, std::uint32_t> taken;
        const auto first_point = static_cast<std::uint32_t>(scene_.points.size());
        const std::size_t first_polygon = scene_.polygons.size();
        std::vector<std::uint32_t> vertex_of_point;
        const auto vertex = [&](std::size_t corner) {
            const std::uint32_t i =
                indices ? indices->index(corner) : static_cast<std::uint32_t>(corner);
            if (i >= positions->count())
                json_.refuse(path + ".indices",
                             fmt::format("found the index {}, expected one below {}, the number of "
                                         "vertices",
                                         i, positions->count()));
            const auto [entry, fresh] = taken.try_emplace(i, 0);
            if (fresh) {
                Vec3 normal;
                if (normals) normal = normalized(world.normal(normals->vec3(i)));
                if (!is_finite(normal)) normal = {};
                entry->second = scene_.add_point(world.point(positions->vec3(i)), normal);
                if (coordinates) scene_.set_texture_coordinates(entry->second, coordinates(i));
                if (colours) vertex_of_point.push_back(i);
            }
            return entry->second;
        };
        const std::size_t corners = indices ? indices->count() : positions->count();
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0)
            json_.refuse(path,
                         fmt::format("found {} corners, expected a multiple of three", corners));
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
        const std::size_t triangles = list ? corners / 3 : corners < 3 ? 0 : corners - 2;
        if (scene_.polygons.size() + triangles > options_.max_polygons)
            json_.refuse(path, fmt::format("the scene has more than {} polygons; --max-polygons "
                                           "raises the limit",
                                           options_.max_polygons));
        const bool mirrored = world.determinant() < 0;
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<std::size_t, 3> of{3 * t, 3 * t + 1, 3 * t + 2};
            // Every second triangle of a strip is turned round (glTF 2.0, section 3.7.2.1).
            if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP)
                of = {t, t + 1 + t % 2, t + 2 - t % 2};
            else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
                of = {t + 1, t + 2, 0};
            Polygon polygon;
            for (std::size_t c = 0; c < 3; ++c)
                polygon.corners[mirrored ? 2 - c : c] = vertex(of[c]);
            polygon.surface = surface;
            // Strips repeat an index on purpose, to go on elsewhere.
            const bool jump = polygon.corners[0] == polygon.corners[1] ||
                              polygon.corners[1] == polygon.corners[2] ||
                              polygon.corners[2] == polygon.corners[0];
            if (list || !jump) scene_.polygons.push_back(polygon);
        }
        if (colours) tint(surface, first_polygon, *colours, vertex_of_point, first_point);
    }

    // A camera looks along −z of its node, y up (glTF 2.0, section 3.10.2).
    void read_camera(const tinygltf::Node& node, const Transform& world) {
        const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(node.camera)];
        const Vec3 view = -normalized(world.z), up = normalized(world.y);
        if (from.type != "perspective" || length(cross(view, up)) < 1e-9 ||
            !is_finite(world.origin)) {
            ++other_cameras_;
            return;
        }
        Camera camera;
        camera.name = !from.name.empty()   ? from.name
                      : !node.name.empty() ? node.name
                                           : fmt::format("camera {}", scene_.cameras.size());
        camera.eye = world.origin;
        camera.look_at = world.origin + view;
        camera.up = up;
        camera.fov_y = from.perspective.yfov * 180.0 / std::numbers::pi;
        if (from.perspective.aspectRatio > 0) camera.aspect = from.perspective.aspectRatio;
        if (from.perspective.znear > 0) camera.near = from.perspective.znear;
        if (from.perspective.zfar > 0) camera.far = from.perspective.zfar;
        scene_.cameras.push_back(std::move(camera));
    }

    void summarise() {
        const auto tell = [&](std::size_t count, const char* what) {
            if (count > 0) warn("", fmt::format("{} {}", count, what));
        };
        tell(no_triangles_, "primitives of points or lines are left out");
        tell(skinned_, "skinned nodes are read in the pose of their mesh");
        tell(morphed_, "primitives with morph targets are read in their base shape");
        tell(other_cameras_, "cameras without a perspective are left out");
    }

    const tinygltf::Model& model_;
    const JsonText& json_;
    const ReadOptions& options_;
    Scene scene_;
    GltfResources resources_;
    GltfTextures textures_;
    GltfLights lights_;
    std::optional<std::uint32_t> no_material_;
    std::vector<GltfMaterial> uses_;  ///< where the patterns of the file's materials lie
    std::map<std::pair<std::uint32_t, std::array<int, 3>>, std::uint32_t> tinted_;
    std::size_t no_triangles_ = 0, skinned_ = 0, morphed_ = 0, other_cameras_ = 0;
};

}  // namespace

bool looks_like_gltf(std::string_view bytes) {
    if (bytes.substr(0, 4) == "glTF") return true;
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '{';
}

Scene parse_gltf(const std::filesystem::path& path, std::string_view bytes,
                 const ReadOptions& options) {
    const GltfParts parts = split_gltf(path.string(), bytes);
    const JsonText json(path.string(), parts.json, !parts.is_binary);
    check_gltf(json);
    const tinygltf::Model model = load_gltf(path, parts, json, options.most_bytes());
    return GltfReader(path, model, json, options).read();
}

Scene read_gltf(const std::filesystem::path& path, const ReadOptions& options) {
    return parse_gltf(path, read_whole_file(path, options.most_bytes()), options);
}

}  // namespace exitance
