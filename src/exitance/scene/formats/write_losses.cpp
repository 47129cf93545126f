// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/write_losses.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "exitance/scene/merge.h"

namespace exitance {

namespace {

bool any(const Spectrum& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v > 0; });
}

}  // namespace

std::vector<std::string> losses(const Scene& scene, const Carries& carries) {
    std::vector<std::string> out;
    const auto tell = [&](std::size_t count, const char* one, const char* several) {
        if (count > 0) out.push_back(fmt::format("{} {}", count, count == 1 ? one : several));
    };
    const auto materials = [&](const auto& is) {
        return static_cast<std::size_t>(
            std::count_if(scene.materials.begin(), scene.materials.end(), is));
    };
    const auto polygons = [&](const auto& is) {
        return static_cast<std::size_t>(
            std::count_if(scene.polygons.begin(), scene.polygons.end(), is));
    };
    if (!carries.quads)
        tell(polygons([](const Polygon& p) { return p.size() == 4; }), "quad becomes two triangles",
             "quads become two triangles each");
    if (!carries.patches)
        tell(polygons([](const Polygon& p) { return p.patches > 0; }),
             "polygon loses the number of patches that it is divided into",
             "polygons lose the number of patches that they are divided into");
    if (!carries.shading_normals)
        tell(static_cast<std::size_t>(std::count_if(scene.normals.begin(), scene.normals.end(),
                                                    [](const Vec3& n) { return n != Vec3{}; })),
             "shading normal is lost", "shading normals are lost");
    if (!carries.surface_names)
        tell(scene.surfaces.size(), "name of a surface is lost", "names of surfaces are lost");
    if (!carries.material_names)
        tell(scene.materials.size(), "name of a material is lost", "names of materials are lost");
    if (!carries.one_sided)
        tell(materials([](const Material& m) { return !m.two_sided && !m.emits(); }),
             "one-sided material becomes two-sided", "one-sided materials become two-sided");
    if (!carries.two_sided_emission)
        tell(materials([](const Material& m) { return m.two_sided && m.emits(); }),
             "material that emits from both sides emits from the front alone",
             "materials that emit from both sides emit from the front alone");
    if (!carries.emitters_reflect)
        tell(materials([](const Material& m) { return m.emits() && any(m.reflectance); }),
             "material that emits loses its reflectance",
             "materials that emit lose their reflectance");
    if (!carries.specular)
        tell(materials([](const Material& m) { return any(m.specular); }),
             "material loses its mirror-like reflection",
             "materials lose their mirror-like reflection");
    if (!carries.transmittance)
        tell(materials([](const Material& m) { return any(m.transmittance); }),
             "material loses its transmittance", "materials lose their transmittance");
    if (!carries.diffuse_transmittance)
        tell(materials([](const Material& m) { return any(m.diffuse_transmittance); }),
             "material loses its diffuse transmittance",
             "materials lose their diffuse transmittance");
    tell(materials([](const Material& m) { return bool(m.reflectance_pattern); }),
         "material loses the texture of its reflectance and keeps the mean",
         "materials lose the texture of their reflectance and keep the mean");
    tell(materials([](const Material& m) { return bool(m.exitance_pattern); }),
         "material loses the texture of its emission and keeps the mean",
         "materials lose the texture of their emission and keep the mean");
    tell(scene.light_scenes.size(), "scene of dimmed light groups is left out",
         "scenes of dimmed light groups are left out");
    tell(materials([](const Material& m) { return !m.group.empty(); }),
         "material loses its light group", "materials lose their light group");
    tell(materials([](const Material& m) { return m.reflectance_file.has_value(); }),
         "material loses the number of its reflectance file",
         "materials lose the number of their reflectance file");
    if (scene.cameras.size() > carries.cameras)
        tell(scene.cameras.size() - carries.cameras, "camera is left out", "cameras are left out");
    tell(scene.luminaires.size(), "luminaire without geometry is left out",
         "luminaires without geometry are left out");
    tell(scene.distant.size(), "sun or sky is left out", "suns and skies are left out");
    tell(scene.grids.size(), "sensor grid is left out", "sensor grids are left out");
    tell(scene.settings.size(), "setting of the solver is left out",
         "settings of the solver are left out");
    tell(scene.form_factors.surfaces.size(),
         "surface loses what was asked of its form factors (base, combination, role)",
         "surfaces lose what was asked of their form factors (base, combination, role)");
    return out;
}

double emission_factor(const Scene& scene, Quantity wanted, std::vector<std::string>& out) {
    const bool emits = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& m) { return m.emits(); });
    if (!emits || scene.quantity == wanted) return 1;
    if (wanted == Quantity::unitless) {
        out.push_back(
            fmt::format("the unit of emission, {}, is lost", exitance_unit(scene.quantity)));
        return 1;
    }
    if (scene.quantity == Quantity::unitless) {
        out.push_back(
            fmt::format("emission without a unit is written as {}", exitance_unit(wanted)));
        return 1;
    }
    out.push_back(fmt::format("emission in {} is written as {} at {} lm/W",
                              exitance_unit(scene.quantity), exitance_unit(wanted),
                              luminous_efficacy));
    return wanted == Quantity::photometric ? luminous_efficacy : 1 / luminous_efficacy;
}

std::vector<std::string> words_of(const std::vector<std::string>& names, bool unique,
                                  const std::string& what, std::vector<std::string>& out) {
    std::vector<std::string> words;
    std::set<std::string> taken;
    std::size_t changed = 0;
    for (const std::string& name : names) {
        std::string word;
        for (const char c : name)
            word += static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\' || c == 0x7f ? '_'
                                                                                               : c;
        if (word.empty()) word = what;
        if (word[0] == '!' || word[0] == '-' || word[0] == '=') word.insert(0, "_");
        const std::string first = word;
        for (std::size_t i = 2; unique && !taken.insert(word).second; ++i)
            word = fmt::format("{}_{}", first, i);
        changed += word != name;
        words.push_back(std::move(word));
    }
    if (changed > 0)
        out.push_back(
            changed == 1
                ? fmt::format("1 name of a {} is changed to a word that is different", what)
                : fmt::format("{} names of {}s are changed to words that are different", changed,
                              what));
    return words;
}

std::vector<std::string> material_words(const Scene& scene, std::vector<std::string>& out) {
    std::vector<std::string> names;
    for (const Material& material : scene.materials) names.push_back(material.name);
    return words_of(names, true, "material", out);
}

std::vector<std::string> surface_words(const Scene& scene, std::vector<std::string>& out) {
    std::vector<std::string> names;
    for (const Surface& surface : scene.surfaces) names.push_back(surface.name);
    return words_of(names, false, "surface", out);
}

std::vector<std::vector<const Polygon*>> polygons_by_surface(const Scene& scene) {
    std::vector<std::vector<const Polygon*>> out(scene.surfaces.size());
    for (const Polygon& polygon : scene.polygons) out[polygon.surface].push_back(&polygon);
    return out;
}

}  // namespace exitance
