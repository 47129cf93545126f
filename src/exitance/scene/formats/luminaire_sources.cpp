// SPDX-License-Identifier: Apache-2.0
// Lamps of a project that have no polygons: photometric files, points and spots.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "exitance/scene/builtin_photometry.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/luminaire_keys.h"
#include "exitance/scene/formats/luminaires.h"
#include "exitance/scene/formats/named_file.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/formats/toml_direction.h"

namespace exitance {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr Vec3 down{0, -1, 0};
constexpr double housing_reflectance = 0.5;

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

// The shortest turn that takes unit `from` to unit `to`, applied to v; about z where they oppose.
Vec3 shortest_turn(const Vec3& from, const Vec3& to, const Vec3& v) {
    const Vec3 axis = cross(from, to);
    const double sine = length(axis), cosine = dot(from, to);
    if (sine < 1e-12) return cosine > 0 ? v : turned(v, {0, 0, 1}, std::numbers::pi);
    return turned(v, axis / sine, std::atan2(sine, cosine));
}

// Hanging with C0 along +x, turned about the vertical, then tilted the shortest way to its aim.
void orient(Luminaire& luminaire, const Vec3& aim, double rotation) {
    luminaire.nadir = down;
    luminaire.c0 = turned({1, 0, 0}, {0, 1, 0}, rotation * degree);
    const Vec3 forward = luminaire.to_world(luminaire.photometry->forward);
    luminaire.c0 = normalized(shortest_turn(forward, aim, luminaire.c0));
    const Vec3 nadir = shortest_turn(forward, aim, down);
    luminaire.nadir = normalized(nadir - luminaire.c0 * dot(nadir, luminaire.c0));
}

// What the lamp's own numbers make of the photometry's candelas.
double level(const TomlTable& table, const Photometry& photometry) {
    const char* chosen = nullptr;
    for (const char* key : {"lumens", "watts", "candela", "lamp_lumens"}) {
        if (!table.has(key)) continue;
        if (chosen)
            throw Error(table.place(key), fmt::format("found both '{}' and '{}', expected one of "
                                                      "them",
                                                      chosen, key));
        chosen = key;
    }
    if (!chosen && table.has("file")) return 1;  // as the file has it
    if (!chosen)
        throw Error(table.place(), "found none of 'lumens', 'watts' and 'candela', expected one");
    const std::string key = chosen;
    const double value = *table.number(key, 0, limits::exitance);
    if (key == "candela") {
        if (table.has("file")) table.refuse("candela", "'lumens' or 'lamp_lumens' with a file");
        return value;
    }
    if (key == "lamp_lumens") {
        if (!table.has("file")) table.refuse("lamp_lumens", "'lumens' without a file");
        if (!photometry.lamp_lumens || !(*photometry.lamp_lumens > 0))
            throw Error(table.place(key),
                        "the file was measured as a whole and has no lamp lumens, expected "
                        "'lumens'");
        return value / *photometry.lamp_lumens;
    }
    const double flux = photometry.flux();
    if (!(flux > 0)) throw Error(table.place("file"), "the file's luminaire is dark");
    return value / flux;
}

}  // namespace

std::shared_ptr<const Photometry> LuminaireReader::photometry(const TomlTable& table) {
    const std::string shape = table.text("shape").value_or("");
    refuse_keys(table, shape.empty() ? "luminaire with a file" : shape,
                {"width", "height", "radius", "up", "exitance"});
    if (!shape.empty()) {
        refuse_keys(table, shape, {"lamp_set", "housing"});
        if (shape == "point") {
            refuse_keys(table, shape, {"beam", "field", "aim", "target", "rotation"});
            return std::make_shared<const Photometry>(isotropic_photometry());
        }
        refuse_keys(table, shape, {"rotation"});
        table.require("beam");
        const double beam = *table.number("beam", 0.1, 170);
        const double field = table.number("field", 0.1, 180).value_or(std::min(180.0, 1.5 * beam));
        if (!(field > 1.01 * beam)) table.refuse("field", "an angle wider than 'beam'");
        return std::make_shared<const Photometry>(spot_photometry(beam, field));
    }
    refuse_keys(table, "luminaire with a file", {"beam", "field", "watts"});
    const std::filesystem::path file = named_file(table, "file", folder_, options_);
    if (!is_lamp_file(file)) table.refuse("file", "a photometric file, .ies or .ldt");
    const std::uint32_t set = table.count("lamp_set", 1, 1000).value_or(1);
    auto& kept = files_[fmt::format("{} {}", set, file.string())];
    if (!kept) {
        LampFile lamp = read_lamp_file(file, set, options_);
        for (Problem& warning : lamp.warnings) scene_.warnings.push_back(std::move(warning));
        kept = std::make_shared<const Photometry>(std::move(lamp.photometry));
    }
    return kept;
}

void LuminaireReader::add_source(const TomlTable& table, const std::string& name,
                                 const Vec3& position) {
    Luminaire luminaire;
    luminaire.name = name;
    luminaire.photometry = photometry(table);
    luminaire.position = position;
    const Vec3 aim = lamp_aim(table, position, down);
    orient(luminaire, aim, table.number("rotation", -360, 360).value_or(0));
    luminaire.colour = lamp_colour(table);
    luminaire.group = table.text("group").value_or(*table.text("name"));
    luminaire.place = table.place();
    const double tilt =
        std::atan2(length(cross(luminaire.nadir, down)), dot(luminaire.nadir, down)) / degree;
    luminaire.multiplier = level(table, *luminaire.photometry) * lamp_factor(table) *
                           luminaire.photometry->tilt.factor(tilt);
    const double flux = luminaire.flux();
    if (!(flux <= limits::exitance))
        throw Error(table.place(),
                    fmt::format("found the flux {:g} in this luminaire, expected at most {:g}",
                                flux, limits::exitance));
    if (table.flag("housing").value_or(false)) {
        const auto& size = luminaire.photometry->housing;
        if (!size)
            throw Error(table.place("housing"),
                        fmt::format("housing: {} does not say how large the luminaire is, expected "
                                    "a file that does, or no housing",
                                    in_quotes(*table.text("file"))));
        give_housing(luminaire, *size);
    }
    scene_.luminaires.push_back(std::move(luminaire));
}

// The housing stands on the luminous body, and what shines upwards does so from its top.
void LuminaireReader::give_housing(Luminaire& luminaire, const Vec3& size) {
    const LuminousOpening& plain = luminaire.photometry->opening;
    const double luminous = plain.extent() > 0 ? plain.size.z : 0;
    const double body = size.z > luminous ? size.z - luminous : size.z;
    auto& housed = housed_[luminaire.photometry.get()];
    if (!housed) {
        Photometry made = *luminaire.photometry;
        if (made.opening.shape == LuminousOpening::Shape::point) {
            made.opening.shape = LuminousOpening::Shape::box;
            made.opening.size = {};
        }
        if (made.opening.sides_shine) {
            made.opening.sides_shine = false;
            made.opening.sides.fill(luminous);
        }
        made.opening.size.z = luminous + body;
        housed = std::make_shared<const Photometry>(std::move(made));
    }
    luminaire.photometry = housed;
    luminaire.position -= luminaire.nadir * (body / 2);
    add_box(luminaire, {size.x, size.y, body}, luminous / 2);
}

// A closed box around the luminaire's position, shifted up by `above`.
void LuminaireReader::add_box(const Luminaire& luminaire, const Vec3& size, double above) {
    Material material;
    material.name = luminaire.name + " housing";
    material.place = luminaire.place;
    material.reflectance.assign(3, housing_reflectance);
    material.exitance.assign(3, 0.0);
    const std::uint32_t made = scene_.add_material(std::move(material));
    const std::uint32_t surface = scene_.add_surface(scene_.materials[made].name, made);
    scene_.surfaces[surface].place = luminaire.place;
    LuminousOpening box;
    box.shape = LuminousOpening::Shape::box;
    box.size = size;
    for (const OpeningFacet& facet : facets(box)) {
        Polygon polygon;
        for (std::uint32_t i = 0; i < 4; ++i)
            polygon.corners[i] = scene_.add_point(
                luminaire.position + luminaire.to_world(facet.corners[i] + Vec3{0, 0, above}));
        polygon.surface = surface;
        polygon.line = static_cast<std::uint32_t>(luminaire.place.line);
        scene_.polygons.push_back(polygon);
    }
}

}  // namespace exitance
