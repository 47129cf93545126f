// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "exitance/math/transform.h"
#include "exitance/scene/formats/gltf_document.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

// Reflectance of what the file gives no material, and of the textures that are not read.
constexpr double unknown_reflectance = 0.5;

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
               const JsonText& json)
        : model_(model), json_(json) {
        scene_.title = path.stem().string();
    }

    Scene read() {
        for (std::size_t i = 0; i < model_.materials.size(); ++i) read_material(i);
        walk();
        summarise();
        for (const Material& material : scene_.materials)
            if (material.emits()) scene_.quantity = Quantity::photometric;
        return std::move(scene_);
    }

  private:
    void warn(const std::string& path, const std::string& what) {
        Problem problem;
        problem.place = json_.place(path);
        problem.what = what;
        scene_.warnings.push_back(std::move(problem));
    }

    void read_material(std::size_t index) {
        const tinygltf::Material& from = model_.materials[index];
        const std::string path = fmt::format("materials[{}]", index);
        Material to;
        to.name = from.name.empty() ? fmt::format("material {}", index) : from.name;
        to.place = json_.place(path);
        to.two_sided = from.doubleSided;
        const auto& base = from.pbrMetallicRoughness;
        to.reflectance = {base.baseColorFactor[0], base.baseColorFactor[1],
                          base.baseColorFactor[2]};
        if (base.baseColorTexture.index >= 0) {
            for (double& rho : to.reflectance) rho *= unknown_reflectance;
            warn(path, fmt::format("the texture of '{}' is not read; its reflectance is taken as "
                                   "{} of its base colour factor",
                                   to.name, unknown_reflectance));
        }
        // Luminance L in every direction of the hemisphere: exitance M = π L (Lambert).
        double strength = 1;
        const auto extension = from.extensions.find("KHR_materials_emissive_strength");
        if (extension != from.extensions.end() && extension->second.Has("emissiveStrength"))
            strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
        to.exitance.assign(3, 0.0);
        if (from.emissiveFactor.size() == 3)
            for (std::size_t b = 0; b < 3; ++b) {
                to.exitance[b] = std::numbers::pi * strength * from.emissiveFactor[b];
                if (to.exitance[b] > limits::exitance)
                    json_.refuse(path, fmt::format("found the exitance {:g}, expected at most {:g}",
                                                   to.exitance[b], limits::exitance));
            }
        if (to.emits() && from.emissiveTexture.index >= 0)
            warn(path,
                 fmt::format("the emissive texture of '{}' is not read; it emits evenly", to.name));
        if (from.alphaMode == "BLEND" || from.extensions.count("KHR_materials_transmission") > 0)
            warn(path,
                 fmt::format("'{}' lets light through in the file; here it does not", to.name));
        scene_.add_material(std::move(to));
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
            if (node.mesh >= 0) read_mesh(node, i, world);
            if (node.camera >= 0) read_camera(node, world);
            if (node.skin >= 0) ++skinned_;
            if (node.extensions.count("KHR_lights_punctual") > 0) ++lights_;
            if (node.extensions.count("EXT_mesh_gpu_instancing") > 0) ++instanced_;
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

    std::optional<GltfAccessor> attribute(const tinygltf::Primitive& primitive, const char* name,
                                          const std::string& path) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        const GltfAccessor accessor(model_, found->second, json_);
        if (accessor.type() != TINYGLTF_TYPE_VEC3)
            json_.refuse(path + ".attributes." + name, "expected an accessor of type VEC3");
        return accessor;
    }

    void read_primitive(const tinygltf::Primitive& primitive, const std::string& path,
                        const std::string& name, const Transform& world) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            ++no_triangles_;
            return;
        }
        const auto positions = attribute(primitive, "POSITION", path);
        if (!positions) json_.refuse(path + ".attributes", "'POSITION' is missing");
        const auto normals = attribute(primitive, "NORMAL", path);
        if (normals && normals->count() != positions->count())
            json_.refuse(path + ".attributes",
                         fmt::format("found {} positions and {} normals, expected as many",
                                     positions->count(), normals->count()));
        std::optional<GltfAccessor> indices;
        if (primitive.indices >= 0) {
            indices.emplace(model_, primitive.indices, json_);
            const int type = indices->component_type();
            if (indices->type() != TINYGLTF_TYPE_SCALAR ||
                (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                 type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                 type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
                json_.refuse(path + ".indices", "expected an accessor of unsigned integer scalars");
        }
        if (!primitive.targets.empty()) ++morphed_;

        const std::uint32_t surface = scene_.add_surface(
            name, primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material)
                                          : no_material(path));
        scene_.surfaces[surface].place = json_.place(path);

        // Vertices are taken over as triangles name them: primitives may share one large accessor.
        std::unordered_map<std::uint32_t, std::uint32_t> taken;
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
            }
            return entry->second;
        };
        const std::size_t corners = indices ? indices->count() : positions->count();
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0)
            json_.refuse(path,
                         fmt::format("found {} corners, expected a multiple of three", corners));
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
        const std::size_t triangles = list ? corners / 3 : corners < 3 ? 0 : corners - 2;
        if (scene_.polygons.size() + triangles > limits::elements)
            json_.refuse(path,
                         fmt::format("the scene has more than {} polygons", limits::elements));
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
        tell(lights_, "lights of KHR_lights_punctual are not read");
        tell(instanced_, "nodes with EXT_mesh_gpu_instancing are read once, not instanced");
        tell(other_cameras_, "cameras without a perspective are left out");
    }

    const tinygltf::Model& model_;
    const JsonText& json_;
    Scene scene_;
    std::optional<std::uint32_t> no_material_;
    std::size_t no_triangles_ = 0, skinned_ = 0, morphed_ = 0, lights_ = 0, instanced_ = 0,
                other_cameras_ = 0;
};

}  // namespace

bool looks_like_gltf(std::string_view bytes) {
    if (bytes.substr(0, 4) == "glTF") return true;
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '{';
}

Scene parse_gltf(const std::filesystem::path& path, std::string_view bytes) {
    const GltfParts parts = split_gltf(path.string(), bytes);
    const JsonText json(path.string(), parts.json, !parts.is_binary);
    check_gltf(json);
    const tinygltf::Model model = load_gltf(path, parts, json);
    return GltfReader(path, model, json).read();
}

Scene read_gltf(const std::filesystem::path& path) {
    return parse_gltf(path, read_whole_file(path));
}

}  // namespace exitance
