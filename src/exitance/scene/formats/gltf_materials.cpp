// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_materials.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

double number(const tinygltf::Material& from, const std::string& extension, const char* key,
              double otherwise) {
    const auto found = from.extensions.find(extension);
    if (found == from.extensions.end() || !found->second.Has(key)) return otherwise;
    return found->second.Get(key).GetNumberAsDouble();
}

bool has(const tinygltf::Material& from, const std::string& extension) {
    return from.extensions.count(extension) > 0;
}

Spectrum spectrum_of(const Vec3& v) {
    return {v.x, v.y, v.z};
}

void read_reflectance(const tinygltf::Material& from, const std::string& path,
                      GltfTextures& textures, GltfMaterial& to) {
    const auto& base = from.pbrMetallicRoughness;
    Material& material = to.material;
    material.reflectance = {base.baseColorFactor[0], base.baseColorFactor[1],
                            base.baseColorFactor[2]};
    if (base.baseColorTexture.index < 0) return;
    // No texel reflects more than light can die out at.
    const double factor =
        *std::max_element(material.reflectance.begin(), material.reflectance.end());
    const double most = factor > largest_reflectance ? largest_reflectance / factor : 1;
    to.reflectance = textures.use(base.baseColorTexture, most, path);
    if (!to.reflectance.texture) {
        for (double& rho : material.reflectance) rho *= unknown_reflectance;
        return;
    }
    material.reflectance_pattern = {to.reflectance.texture, material.reflectance};
    material.reflectance = spectrum_of(material.reflectance_pattern.mean());
}

// Luminance L in every direction of the hemisphere: exitance M = π L (Lambert).
void read_emission(const tinygltf::Material& from, const std::string& path, GltfTextures& textures,
                   const JsonText& json, const GltfTextures::Warn& warn, GltfMaterial& to) {
    const double strength = number(from, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    Material& material = to.material;
    material.exitance.assign(3, 0.0);
    if (from.emissiveFactor.size() != 3) return;
    for (std::size_t b = 0; b < 3; ++b) {
        material.exitance[b] = std::numbers::pi * strength * from.emissiveFactor[b];
        if (material.exitance[b] > limits::exitance)
            json.refuse(path, fmt::format("found the exitance {:g}, expected at most {:g}",
                                          material.exitance[b], limits::exitance));
    }
    if (!material.emits() || from.emissiveTexture.index < 0) return;
    to.exitance = textures.use(from.emissiveTexture, 1, path);
    if (!to.exitance.texture) {
        warn(path, fmt::format("'{}' emits evenly, without its texture", material.name));
        return;
    }
    material.exitance_pattern = {to.exitance.texture, material.exitance};
    material.exitance = spectrum_of(material.exitance_pattern.mean());
}

void scale(Material& material, double share) {
    for (double& rho : material.reflectance) rho *= share;
    for (double& rho : material.reflectance_pattern.factor) rho *= share;
}

// What goes through is taken from the diffuse part, tinted alike (KHR_materials_transmission).
void read_transmission(const tinygltf::Material& from, const std::string& path,
                       const GltfTextures::Warn& warn, Material& to) {
    double through = number(from, "KHR_materials_transmission", "transmissionFactor", 0);
    if (from.alphaMode == "BLEND") {
        const double uncovered = 1 - from.pbrMetallicRoughness.baseColorFactor[3];
        through = through + (1 - through) * uncovered;
        if (from.pbrMetallicRoughness.baseColorTexture.index >= 0)
            warn(path, fmt::format("the transparency in the texture of '{}' is not read", to.name));
    }
    if (from.alphaMode == "MASK")
        warn(path,
             fmt::format("'{}' is cut out by its texture in the file; here it is whole", to.name));
    if (has(from, "KHR_materials_ior")) {
        const double ior = number(from, "KHR_materials_ior", "ior", 1.5);
        if (ior >= 1) to.refractive_index = ior;
    }
    if (!(through > 0)) return;
    to.transmittance = to.reflectance;
    for (double& tau : to.transmittance) tau *= through;
    scale(to, 1 - through);
}

// Mirror-like reflectance at normal incidence, F0 (KHR_materials_ior, KHR_materials_specular), as
// far as the diffuse part leaves room for it.
void read_gloss(const tinygltf::Material& from, Material& to) {
    if (!has(from, "KHR_materials_specular") && !to.refractive_index) return;
    const double n = to.refractive_index.value_or(1.5);
    const double f0 = std::pow((n - 1) / (n + 1), 2) *
                      number(from, "KHR_materials_specular", "specularFactor", 1);
    std::array<double, 3> colour{1, 1, 1};
    const auto gloss = from.extensions.find("KHR_materials_specular");
    if (gloss != from.extensions.end() && gloss->second.Has("specularColorFactor"))
        for (std::size_t b = 0; b < 3; ++b)
            colour[b] = gloss->second.Get("specularColorFactor")
                            .Get(static_cast<int>(b))
                            .GetNumberAsDouble();
    for (std::size_t b = 0; b < 3; ++b) {
        const double through = to.transmittance.empty() ? 0 : to.transmittance[b];
        to.specular.push_back(std::min(std::min(1.0, f0 * colour[b]),
                                       std::max(0.0, 1 - to.reflectance[b] - through)));
    }
    to.roughness = from.pbrMetallicRoughness.roughnessFactor;
}

}  // namespace

GltfMaterial read_gltf_material(const tinygltf::Material& from, std::size_t index,
                                GltfTextures& textures, const JsonText& json,
                                const GltfTextures::Warn& warn) {
    const std::string path = fmt::format("materials[{}]", index);
    GltfMaterial out;
    out.material.name = from.name.empty() ? fmt::format("material {}", index) : from.name;
    out.material.place = json.place(path);
    out.material.two_sided = from.doubleSided;
    read_reflectance(from, path, textures, out);
    read_emission(from, path, textures, json, warn, out);
    read_transmission(from, path, warn, out.material);
    read_gloss(from, out.material);
    return out;
}

}  // namespace exitance
