// SPDX-License-Identifier: Apache-2.0
// What the glTF 2.0 specification asks of the properties that the reader uses.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/gltf_document.h"
#include "exitance/scene/formats/limits.h"

namespace exitance {

namespace {

constexpr double huge = std::numeric_limits<double>::max();
constexpr std::size_t longest = std::numeric_limits<std::int32_t>::max();

// Extensions a file may require: they change nothing that is read here, or are read.
const std::array<std::string, 13> supported_extensions{"EXT_lights_ies",
                                                       "EXT_mesh_gpu_instancing",
                                                       "EXT_meshopt_compression",
                                                       "KHR_draco_mesh_compression",
                                                       "KHR_lights_punctual",
                                                       "KHR_materials_emissive_strength",
                                                       "KHR_materials_ior",
                                                       "KHR_materials_specular",
                                                       "KHR_materials_transmission",
                                                       "KHR_materials_unlit",
                                                       "KHR_materials_volume",
                                                       "KHR_mesh_quantization",
                                                       "KHR_texture_transform"};

// Calls `check` for every entry of the root's array `name`; returns how many there are.
std::size_t for_each(const JsonNode& root, const std::string& name,
                     const std::function<void(const JsonNode&)>& check) {
    const JsonNode entries = root.member(name);
    if (!entries) return 0;
    const std::size_t count = entries.array_size();
    for (std::size_t i = 0; i < count; ++i) {
        const JsonNode entry = entries.element(i);
        if (!entry.value->is_object()) entry.expected("an object");
        if (const JsonNode label = entry.member("name")) label.string();
        check(entry);
    }
    return count;
}

std::size_t size_of(const JsonNode& root, const std::string& name) {
    const JsonNode entries = root.member(name);
    return entries ? entries.array_size() : 0;
}

void check_index(const JsonNode& object, const std::string& key, const JsonNode& root,
                 const std::string& of, bool required = false) {
    const JsonNode node = required ? object.required(key) : object.member(key);
    if (node) node.index(size_of(root, of), of);
}

void check_indices(const JsonNode& object, const std::string& key, const JsonNode& root,
                   const std::string& of) {
    const JsonNode list = object.member(key);
    if (!list) return;
    const std::size_t count = list.array_size(), most = size_of(root, of);
    for (std::size_t i = 0; i < count; ++i) list.element(i).index(most, of);
}

std::size_t whole(const JsonNode& object, const std::string& key, std::size_t least,
                  std::size_t most, bool required, std::size_t otherwise = 0) {
    const JsonNode node = required ? object.required(key) : object.member(key);
    if (!node) return otherwise;
    return node.whole(least, most, fmt::format("a whole number from {} to {}", least, most));
}

void check_asset(const JsonNode& root) {
    if (!root.value->is_object()) root.expected("a glTF object");
    const JsonNode version = root.required("asset").required("version");
    if (version.string().rfind("2.", 0) != 0) version.expected("a glTF version 2.x");
    if (const JsonNode required = root.member("extensionsRequired"))
        for (std::size_t i = 0; i < required.array_size(); ++i) {
            const JsonNode extension = required.element(i);
            const std::string& name = extension.string();
            if (std::find(supported_extensions.begin(), supported_extensions.end(), name) ==
                supported_extensions.end())
                extension.expected(
                    "an extension that can be read here; the file cannot be read without it");
        }
    if (const JsonNode used = root.member("extensionsUsed"))
        for (std::size_t i = 0; i < used.array_size(); ++i) used.element(i).string();
}

void check_scenes_and_nodes(const JsonNode& root) {
    check_index(root, "scene", root, "scenes");
    for_each(root, "scenes",
             [&](const JsonNode& scene) { check_indices(scene, "nodes", root, "nodes"); });
    for_each(root, "nodes", [&](const JsonNode& node) {
        check_index(node, "mesh", root, "meshes");
        check_index(node, "camera", root, "cameras");
        if (const JsonNode extensions = node.member("extensions"))
            if (const JsonNode instances = extensions.member("EXT_mesh_gpu_instancing")) {
                const JsonNode attributes = instances.required("attributes");
                if (!attributes.value->is_object()) attributes.expected("an object");
                for (const auto& [key, value] : attributes.value->items())
                    check_index(attributes, key, root, "accessors");
            }
        check_indices(node, "children", root, "nodes");
        const double most = limits::coordinate;
        if (const JsonNode matrix = node.member("matrix")) matrix.numbers(16, -most, most);
        if (const JsonNode move = node.member("translation")) move.numbers(3, -most, most);
        if (const JsonNode scale = node.member("scale")) scale.numbers(3, -most, most);
        if (const JsonNode turn = node.member("rotation")) {
            turn.numbers(4, -2, 2);
            double squared = 0;
            for (const auto& q : *turn.value) squared += q.get<double>() * q.get<double>();
            if (squared < 0.25) turn.expected("a quaternion of length 1");
        }
    });
}

void check_meshes(const JsonNode& root) {
    for_each(root, "meshes", [&](const JsonNode& mesh) {
        const JsonNode primitives = mesh.required("primitives");
        for (std::size_t i = 0; i < primitives.array_size(); ++i) {
            const JsonNode primitive = primitives.element(i);
            const JsonNode attributes = primitive.required("attributes");
            if (!attributes.value->is_object()) attributes.expected("an object");
            for (const auto& [key, value] : attributes.value->items())
                check_index(attributes, key, root, "accessors");
            check_index(primitive, "indices", root, "accessors");
            check_index(primitive, "material", root, "materials");
            whole(primitive, "mode", 0, 6, false);
        }
    });
}

void check_component_type(const JsonNode& object) {
    const JsonNode type = object.required("componentType");
    const std::size_t code = type.whole(0, longest, "a component type");
    if (code != 5120 && code != 5121 && code != 5122 && code != 5123 && code != 5125 &&
        code != 5126)
        type.expected("a component type: 5120, 5121, 5122, 5123, 5125 or 5126");
}

void check_accessors(const JsonNode& root) {
    for_each(root, "accessors", [&](const JsonNode& accessor) {
        check_index(accessor, "bufferView", root, "bufferViews");
        whole(accessor, "byteOffset", 0, longest, false);
        whole(accessor, "count", 1, std::numeric_limits<std::uint32_t>::max() - 1, true);
        check_component_type(accessor);
        if (const JsonNode flag = accessor.member("normalized")) flag.boolean();
        const JsonNode type = accessor.required("type");
        static const std::array<std::string, 7> types{"SCALAR", "VEC2", "VEC3", "VEC4",
                                                      "MAT2",   "MAT3", "MAT4"};
        if (std::find(types.begin(), types.end(), type.string()) == types.end())
            type.expected("SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4" +
                          suggestion(type.string(), types));
        if (const JsonNode sparse = accessor.member("sparse")) {
            whole(sparse, "count", 1, longest, true);
            for (const char* part : {"indices", "values"}) {
                const JsonNode where = sparse.required(part);
                check_index(where, "bufferView", root, "bufferViews", true);
                whole(where, "byteOffset", 0, longest, false);
            }
            check_component_type(sparse.required("indices"));
        }
    });
    for_each(root, "bufferViews", [&](const JsonNode& view) {
        check_index(view, "buffer", root, "buffers", true);
        whole(view, "byteOffset", 0, longest, false);
        whole(view, "byteLength", 1, longest, true);
        whole(view, "byteStride", 4, 252, false);
    });
    for_each(root, "buffers", [&](const JsonNode& buffer) {
        whole(buffer, "byteLength", 1, longest, true);
        if (const JsonNode uri = buffer.member("uri")) uri.string();
    });
}

// The extension `name` of an object; null if it has none.
JsonNode extension(const JsonNode& object, const std::string& name) {
    const JsonNode extensions = object.member("extensions");
    return extensions ? extensions.member(name) : extensions;
}

void check_texture(const JsonNode& owner, const std::string& key, const JsonNode& root) {
    const JsonNode info = owner.member(key);
    if (!info) return;
    check_index(info, "index", root, "textures", true);
    whole(info, "texCoord", 0, 1000, false);
    if (const JsonNode transform = extension(info, "KHR_texture_transform")) {
        const double most = 1e6;
        if (const JsonNode move = transform.member("offset")) move.numbers(2, -most, most);
        if (const JsonNode scale = transform.member("scale")) scale.numbers(2, -most, most);
        if (const JsonNode turn = transform.member("rotation"))
            turn.number(-most, most, "an angle in radians");
        whole(transform, "texCoord", 0, 1000, false);
    }
}

void check_number(const JsonNode& object, const std::string& key, double least, double most,
                  const std::string& what) {
    if (const JsonNode value = object.member(key)) value.number(least, most, what);
}

void check_materials(const JsonNode& root) {
    for_each(root, "materials", [&](const JsonNode& material) {
        if (const JsonNode pbr = material.member("pbrMetallicRoughness")) {
            if (const JsonNode colour = pbr.member("baseColorFactor")) colour.numbers(4, 0, 1);
            check_texture(pbr, "baseColorTexture", root);
        }
        check_texture(material, "emissiveTexture", root);
        if (const JsonNode emissive = material.member("emissiveFactor"))
            emissive.numbers(3, 0, limits::exitance);
        if (const JsonNode both = material.member("doubleSided")) both.boolean();
        if (const JsonNode alpha = material.member("alphaMode")) alpha.string();
        if (const JsonNode strong = extension(material, "KHR_materials_emissive_strength"))
            check_number(strong, "emissiveStrength", 0, limits::exitance, "a strength, 0 or more");
        if (const JsonNode glass = extension(material, "KHR_materials_transmission"))
            check_number(glass, "transmissionFactor", 0, 1, "a share, 0 to 1");
        if (const JsonNode ior = extension(material, "KHR_materials_ior"))
            check_number(ior, "ior", 0, 1e3, "an index of refraction, 0 or 1 and more");
        if (const JsonNode gloss = extension(material, "KHR_materials_specular")) {
            check_number(gloss, "specularFactor", 0, 1, "a share, 0 to 1");
            if (const JsonNode colour = gloss.member("specularColorFactor"))
                colour.numbers(3, 0, 1e3);
        }
    });
}

// Lights and where they hang; `name` is the extension that declares them.
void check_lights(const JsonNode& root, const std::string& name,
                  const std::function<void(const JsonNode&)>& check) {
    const JsonNode declared = extension(root, name);
    std::size_t count = 0;
    if (declared) count = for_each(declared, "lights", check);
    for_each(root, "nodes", [&](const JsonNode& node) {
        if (const JsonNode placed = extension(node, name)) {
            placed.required("light").index(count, "lights");
            check_number(placed, "multiplier", 0, limits::exitance, "a factor, 0 or more");
            if (const JsonNode colour = placed.member("color"))
                colour.numbers(3, 0, limits::exitance);
        }
    });
}

void check_all_lights(const JsonNode& root) {
    check_lights(root, "KHR_lights_punctual", [](const JsonNode& light) {
        light.required("type").string();
        if (const JsonNode colour = light.member("color")) colour.numbers(3, 0, limits::exitance);
        check_number(light, "intensity", 0, limits::exitance, "an intensity, 0 or more");
        if (const JsonNode spot = light.member("spot")) {
            check_number(spot, "innerConeAngle", 0, 1.5708, "an angle from 0 to π/2");
            check_number(spot, "outerConeAngle", 0, 1.5708, "an angle from 0 to π/2");
        }
    });
    check_lights(root, "EXT_lights_ies", [](const JsonNode&) {});
}

void check_cameras(const JsonNode& root) {
    for_each(root, "cameras", [](const JsonNode& camera) {
        if (camera.required("type").string() != "perspective") return;
        const JsonNode view = camera.required("perspective");
        view.required("yfov").number(1e-4, 3.13, "an angle in radians above 0 and below π");
        if (const JsonNode aspect = view.member("aspectRatio"))
            aspect.number(1e-3, 1e3, "a ratio above 0");
        for (const char* key : {"znear", "zfar"})
            if (const JsonNode distance = view.member(key))
                distance.number(1e-12, huge, "a distance above 0");
    });
}

}  // namespace

void check_gltf(const JsonText& json) {
    const JsonNode root{&json, &json.root(), ""};
    check_asset(root);
    check_scenes_and_nodes(root);
    check_meshes(root);
    check_accessors(root);
    check_materials(root);
    check_cameras(root);
    check_all_lights(root);
}

}  // namespace exitance
