// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/luminaires.h"

#include <fmt/format.h>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/luminaire_keys.h"
#include "exitance/scene/formats/luminaire_shapes.h"
#include "exitance/scene/formats/toml_direction.h"

namespace exitance {

namespace {

// Returns the area that emits [m²].
double lamp_shape(Scene& scene, std::uint32_t surface, const TomlTable& table,
                  const Vec3& position) {
    const std::string shape = *table.text("shape");
    refuse_keys(
        table, shape,
        {"file", "lamp_set", "lamp_lumens", "candela", "beam", "field", "rotation", "housing"});
    const auto sizes = [&](const std::vector<std::string>& needed,
                           const std::vector<std::string>& unused) {
        for (const std::string& key : needed) table.require(key);
        refuse_keys(table, shape, unused);
    };
    const auto size = [&](const char* key) {
        return *table.number(key, limits::length, limits::coordinate);
    };
    if (shape == "rectangle") {
        sizes({"width", "height"}, {"radius"});
        const Vec3 aim = lamp_aim(table, position, std::nullopt);
        return add_rectangle(scene, surface, position, aim, up_beside(table, aim), size("width"),
                             size("height"));
    }
    if (shape == "disc") {
        sizes({"radius"}, {"width", "height", "up"});
        return add_disc(scene, surface, position, lamp_aim(table, position, std::nullopt),
                        size("radius"));
    }
    if (shape != "sphere") table.refuse("shape", "rectangle, disc, sphere, point or spot");
    sizes({"radius"}, {"width", "height", "aim", "target", "up"});
    return add_sphere(scene, surface, position, size("radius"));
}

// Φ = ∫ M dA: M = Φ / A in the proportions of `color`, whose luminous value is made 1.
Spectrum lamp_exitance(const TomlTable& table, double area) {
    const int given = table.has("lumens") + table.has("watts") + table.has("exitance");
    if (given != 1)
        throw Error(table.place(), fmt::format("found {} of 'lumens', 'watts' and 'exitance', "
                                               "expected one",
                                               given == 0 ? "none" : "several"));
    const Spectrum colour = lamp_colour(table);
    Spectrum exitance(3, 1.0);
    if (table.has("exitance")) {
        for (const char* key : {"color", "color_temperature"})
            if (table.is_array("exitance") && table.has(key))
                throw Error(table.place(key),
                            fmt::format("found '{}' beside an exitance per band, expected one of "
                                        "them",
                                        key));
        exitance = *table.spectrum("exitance", 0, limits::exitance);
    } else {
        const char* key = table.has("lumens") ? "lumens" : "watts";
        exitance.assign(3, *table.number(key, 0, limits::exitance) / area);
    }
    const double factor = lamp_factor(table);
    for (std::size_t b = 0; b < 3; ++b) {
        exitance[b] *= colour[b] * factor;
        if (!(exitance[b] <= limits::exitance))
            throw Error(table.place(),
                        fmt::format("found the exitance {:g} in this luminaire, expected at most "
                                    "{:g}",
                                    exitance[b], limits::exitance));
    }
    return exitance;
}

}  // namespace

void LuminaireReader::add(const TomlTable& table) {
    for (const char* key : {"name", "position"}) table.require(key);
    if (!table.has("file")) table.require("shape");
    if (table.has("file") && table.has("shape"))
        throw Error(table.place("shape"), "found both 'file' and 'shape', expected one of them");
    const std::string shape = table.text("shape").value_or("");
    const bool source = table.has("file") || shape == "point" || shape == "spot";
    const std::string name = *table.text("name");
    lamps_ += lamp_count(table);
    if (lamps_ > options_.max_luminaires)
        throw Error(table.has("rows") ? table.place("rows") : table.place(),
                    fmt::format("with this the project has {} lamps, more than {}; "
                                "--max-luminaires raises the limit",
                                lamps_, options_.max_luminaires));
    for (const char* key : {"lumens", "watts", "candela", "lamp_lumens"})
        if (table.has(key) && *table.number(key, 0, limits::exitance) == 0)
            scene_.warnings.push_back(
                {table.place(key), fmt::format("{}: found 0: the luminaire is dark", key)});
    const std::vector<Vec3> positions = lamp_positions(table);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (scene_.polygons.size() > options_.max_polygons)
            throw Error(table.place(), fmt::format("with this array the scene has more than {} "
                                                   "polygons; --max-polygons raises the limit",
                                                   options_.max_polygons));
        const std::string own = positions.size() == 1 ? name : fmt::format("{} {}", name, i + 1);
        source ? add_source(table, own, positions[i]) : add_area(table, own, positions[i]);
    }
}

void LuminaireReader::add_area(const TomlTable& table, const std::string& name,
                               const Vec3& position) {
    Material material;
    material.name = name;
    material.place = table.place();
    material.reflectance.assign(3, 0.0);
    material.exitance.assign(3, 0.0);
    // Without a group of its own choice a lamp is its own group, and an array of them is one.
    material.group = table.text("group").value_or(*table.text("name"));
    const std::uint32_t made = scene_.add_material(std::move(material));
    const std::uint32_t surface = scene_.add_surface(scene_.materials[made].name, made);
    scene_.surfaces[surface].luminaire = true;
    scene_.surfaces[surface].place = table.place();
    const double area = lamp_shape(scene_, surface, table, position);
    scene_.materials[made].exitance = lamp_exitance(table, area);
}

}  // namespace exitance
