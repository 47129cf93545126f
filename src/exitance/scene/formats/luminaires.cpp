// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/luminaires.h"

#include <fmt/format.h>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/luminaire_shapes.h"
#include "exitance/scene/formats/toml_direction.h"

namespace exitance {

namespace {

// Returns the area that emits [m²].
double lamp_shape(Scene& scene, std::uint32_t surface, const TomlTable& table) {
    const std::string shape = *table.text("shape");
    const Vec3 position = *table.vector("position");
    const auto sizes = [&](const std::vector<std::string>& needed,
                           const std::vector<std::string>& unused) {
        for (const std::string& key : needed) table.require(key);
        for (const std::string& key : unused)
            if (table.has(key))
                throw Error(table.place(key), fmt::format("a {} has no '{}'", shape, key));
    };
    const auto size = [&](const char* key) {
        return *table.number(key, limits::length, limits::coordinate);
    };
    if (shape == "rectangle") {
        sizes({"aim", "width", "height"}, {"radius"});
        const Vec3 aim = direction(table, "aim", {});
        return add_rectangle(scene, surface, position, aim, up_beside(table, aim), size("width"),
                             size("height"));
    }
    if (shape == "disc") {
        sizes({"aim", "radius"}, {"width", "height", "up"});
        return add_disc(scene, surface, position, direction(table, "aim", {}), size("radius"));
    }
    if (shape != "sphere") table.refuse("shape", "rectangle, disc or sphere");
    sizes({"radius"}, {"width", "height", "aim", "up"});
    return add_sphere(scene, surface, position, size("radius"));
}

// Φ = ∫ M dA: M = Φ / A in the proportions of `color`, whose luminous value is made 1.
Spectrum lamp_exitance(const TomlTable& table, double area) {
    const int given = table.has("lumens") + table.has("watts") + table.has("exitance");
    if (given != 1)
        throw Error(table.place(), fmt::format("found {} of 'lumens', 'watts' and 'exitance', "
                                               "expected one",
                                               given == 0 ? "none" : "several"));
    Spectrum colour = table.spectrum("color", 0, limits::exitance).value_or(Spectrum(3, 1.0));
    const double value = luminance(colour);
    if (!(value > limits::length)) table.refuse("color", "a colour that is not black");
    Spectrum exitance(3, 1.0);
    if (table.has("exitance")) {
        if (table.is_array("exitance") && table.has("color"))
            throw Error(table.place("color"),
                        "found 'color' beside an exitance per band, expected one of them");
        exitance = *table.spectrum("exitance", 0, limits::exitance);
    } else {
        const char* key = table.has("lumens") ? "lumens" : "watts";
        exitance.assign(3, *table.number(key, 0, limits::exitance) / area);
    }
    for (std::size_t b = 0; b < 3; ++b) {
        exitance[b] *= colour[b] / value;
        if (!(exitance[b] <= limits::exitance))
            throw Error(table.place(),
                        fmt::format("found the exitance {:g} in this luminaire, expected at most "
                                    "{:g}",
                                    exitance[b], limits::exitance));
    }
    return exitance;
}

}  // namespace

std::vector<std::string> luminaire_keys() {
    return {"name",   "shape",  "position", "aim",      "up",    "width", "height",
            "radius", "lumens", "watts",    "exitance", "color", "group"};
}

void add_luminaire(Scene& scene, const TomlTable& table) {
    for (const char* key : {"name", "shape", "position"}) table.require(key);
    Material material;
    material.name = *table.text("name");
    material.place = table.place();
    material.reflectance.assign(3, 0.0);
    material.exitance.assign(3, 0.0);
    // Without a group of its own choice a lamp is its own group.
    material.group = table.text("group").value_or(material.name);
    const std::uint32_t made = scene.add_material(std::move(material));
    const std::uint32_t surface = scene.add_surface(scene.materials[made].name, made);
    scene.surfaces[surface].luminaire = true;
    scene.surfaces[surface].place = table.place();
    const double area = lamp_shape(scene, surface, table);
    scene.materials[made].exitance = lamp_exitance(table, area);
}

}  // namespace exitance
