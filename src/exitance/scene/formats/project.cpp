// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/project.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "exitance/math/transform.h"
#include "exitance/scene/formats/daylight.h"
#include "exitance/scene/formats/glob.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/luminaires.h"
#include "exitance/scene/formats/named_file.h"
#include "exitance/scene/formats/project_keys.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/formats/toml_direction.h"
#include "exitance/scene/formats/toml_table.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/merge.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double farthest = limits::coordinate, shortest = limits::length;

// Rodrigues' rotation of the unit axes by `angle` about the unit vector `a`.
Transform rotation(const Vec3& a, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const Vec3& v) {
        return v * c + cross(a, v) * s + a * (dot(a, v) * (1 - c));
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
}

class ProjectReader {
  public:
    ProjectReader(const std::filesystem::path& path, std::string_view text,
                  const ReadGeometry& read_geometry, const ReadOptions& options)
        : path_(path),
          root_(TomlTable::parse(path.string(), text, "a project", project_keys(""))),
          read_geometry_(read_geometry),
          options_(options),
          most_polygons_(std::min<std::uint64_t>(options.max_polygons, limits::elements)) {}

    Scene read() {
        scene_.title = root_.text("title").value_or(as_utf8(path_.stem().string()));
        const auto materials = root_.tables("material", project_keys("material"));
        const auto luminaires = root_.tables("luminaire", project_keys("luminaire"));
        std::vector<Part> parts;
        for (const TomlTable& table : root_.tables("geometry", project_keys("geometry")))
            parts.push_back(geometry(table));
        decide_quantity(materials, luminaires, parts);
        if (!parts.empty()) scene_.up = normalized(parts[0].placing.vector(parts[0].scene.up));
        for (Part& part : parts) {
            if (scene_.polygons.size() + part.scene.polygons.size() > most_polygons_)
                throw Error(part.place, fmt::format("with this file the scene has more than {} "
                                                    "polygons; --max-polygons raises the limit",
                                                    most_polygons_));
            merge(scene_, std::move(part.scene), part.placing);
        }
        for (const TomlTable& table : materials) material(table);
        for (const TomlTable& table : root_.tables("polygon", project_keys("polygon")))
            polygon(table);
        LuminaireReader lamps(scene_, path_.parent_path(), options_);
        for (const TomlTable& table : luminaires) lamps.add(table);
        add_daylight(scene_, root_, path_.parent_path(), options_);
        for (const TomlTable& table : root_.tables("camera", project_keys("camera"))) camera(table);
        for (const TomlTable& table : root_.tables("grid", project_keys("grid"))) grid(table);
        // [solve] is kept as text; whoever solves knows the names.
        for (const auto& [name, value, place] : root_.scalars("solve"))
            scene_.settings.push_back({name, value, place});
        for (const auto& [place, factors] : root_.scalar_tables("scenes"))
            light_scene(place, factors);
        return std::move(scene_);
    }

  private:
    struct Part {
        Scene scene;
        Transform placing;
        Place place;
    };

    // [[geometry]]: the file first as it is in its own unit and axes, then scaled, turned, moved.
    Part geometry(const TomlTable& table) {
        table.require("file");
        const std::filesystem::path file = named_file(table, "file", path_.parent_path(), options_);

        Transform placing = Transform::scale(unit(table));
        const std::string up = table.text("up").value_or("y");
        const Transform x_up{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {}};
        const Transform z_up{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}};
        if (up != "x" && up != "y" && up != "z") table.refuse("up", "x, y or z");
        if (up == "x") placing = x_up.after(placing);
        if (up == "z") placing = z_up.after(placing);
        placing =
            Transform::scale(table.number("scale", shortest, farthest).value_or(1)).after(placing);
        if (const auto turn = table.numbers("rotate", 4, -farthest, farthest)) {
            const Vec3 axis{(*turn)[0], (*turn)[1], (*turn)[2]};
            if (!(length(axis) > shortest))
                table.refuse("rotate", "[x, y, z, degrees] with an axis that is not zero");
            placing = rotation(normalized(axis), (*turn)[3] * pi / 180).after(placing);
        }
        placing.origin += table.vector("translate").value_or(Vec3{});
        return {read_geometry_(file, table.place("file")), placing, table.place("file")};
    }

    static double unit(const TomlTable& table) {
        static const std::map<std::string, double> metres{
            {"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
        if (!table.has("unit")) return 1;
        if (table.is_number("unit")) return *table.number("unit", shortest, farthest);
        const auto word = table.text("unit");
        const auto found = metres.find(*word);
        if (found == metres.end()) table.refuse("unit", "m, cm, mm, in, ft or a number of metres");
        return found->second;
    }

    // What a key in lumens, cd/m² or watts says about the quantity of the scene.
    void demand(const TomlTable& table, const std::string& key, Quantity quantity) {
        if (!table.has(key)) return;
        if (!quantity_) quantity_ = quantity;
        if (*quantity_ != quantity)
            throw Error(table.place(key),
                        fmt::format("'{}' is {}, but the quantity of this project is {}", key,
                                    quantity_name(quantity), quantity_name(*quantity_)));
    }
    static std::string quantity_name(Quantity quantity) {
        if (quantity == Quantity::radiometric) return "radiometric";
        return quantity == Quantity::photometric ? "photometric" : "unitless";
    }

    std::optional<Quantity> given_quantity() const {
        const auto word = root_.text("quantity");
        if (!word) return std::nullopt;
        for (const Quantity q : {Quantity::unitless, Quantity::radiometric, Quantity::photometric})
            if (*word == quantity_name(q)) return q;
        root_.refuse("quantity", "radiometric, photometric or unitless");
    }

    // What the project says; else what its own keys are measured in; else what the files say; else
    // what daylight is measured in.
    void decide_quantity(const std::vector<TomlTable>& materials,
                         const std::vector<TomlTable>& luminaires, const std::vector<Part>& parts) {
        quantity_ = given_quantity();
        for (const TomlTable& table : materials) demand(table, "luminance", Quantity::photometric);
        for (const TomlTable& table : luminaires) {
            for (const char* key : {"lumens", "lamp_lumens", "candela", "file"})
                demand(table, key, Quantity::photometric);
            demand(table, "watts", Quantity::radiometric);
        }
        for (const Part& part : parts)
            if (!quantity_ && part.scene.quantity != Quantity::unitless)
                quantity_ = part.scene.quantity;
        // Without more, sun and sky are as bright as outdoors, in lux.
        if (!quantity_ && (root_.has("sky") || root_.has("sun"))) quantity_ = Quantity::photometric;
        scene_.quantity = quantity_.value_or(Quantity::unitless);
    }

    // Emission of a material: exitance M, or luminance L of an even glow: M = π L (Lambert).
    std::optional<Spectrum> emission(const TomlTable& table) const {
        if (table.has("exitance") && table.has("luminance"))
            throw Error(table.place("luminance"),
                        "found both 'exitance' and 'luminance', expected one of them");
        if (table.has("exitance")) return table.spectrum("exitance", 0, limits::exitance);
        auto value = table.spectrum("luminance", 0, limits::exitance / 4);
        if (value)
            for (double& band : *value) band *= pi;
        return value;
    }

    std::vector<std::string> material_names() const {
        std::vector<std::string> names;
        std::set<std::string> seen;
        for (const Material& material : scene_.materials)
            if (seen.insert(material.name).second) names.push_back(material.name);
        return names;
    }

    void material(const TomlTable& table) {
        if (table.has("match") == table.has("name"))
            throw Error(
                table.place(),
                table.has("name")
                    ? "found both 'match' and 'name', expected one: match changes materials, "
                      "name makes one"
                    : "[[material]] has neither 'match' nor 'name'");
        if (table.has("name")) return new_material(table);
        const std::string pattern = *table.text("match");
        std::size_t matched = 0;
        for (Material& material : scene_.materials) {
            if (!matches_glob(pattern, material.name)) continue;
            ++matched;
            change(material, table);
        }
        if (matched > 0) return;
        const std::vector<std::string> names = material_names();
        std::string known;
        for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 8); ++i)
            known += (i > 0 ? ", " : "") + names[i];
        if (names.size() > 8) known += ", …";
        throw Error(
            table.place("match"),
            fmt::format("{} matches no material; there {}{}", in_quotes(pattern),
                        names.empty() ? "are none" : "are: " + known, suggestion(pattern, names)));
    }

    void change(Material& material, const TomlTable& table) const {
        if (const auto rho = table.spectrum("reflectance", 0, 1)) {
            material.reflectance = *rho;
            material.reflectance_pattern = {};
            material.place = table.place("reflectance");
        }
        if (const auto e = emission(table)) {
            material.exitance = *e;
            material.exitance_pattern = {};
        }
        if (const auto group = table.text("group")) material.group = *group;
        if (const auto tau = table.spectrum("transmittance", 0, 1)) {
            material.transmittance = *tau;
            for (std::size_t b = 0; b < tau->size(); ++b)
                if ((*tau)[b] + material.reflectance[b] > 1)
                    table.refuse("transmittance", "at most 1 together with the reflectance");
        }
        if (const auto both = table.flag("two_sided")) material.two_sided = *both;
    }

    void new_material(const TomlTable& table) {
        Material material;
        material.name = *table.text("name");
        material.place = table.place("name");
        const auto named = [&](const Material& other) { return other.name == material.name; };
        if (std::any_of(scene_.materials.begin(), scene_.materials.end(), named))
            throw Error(material.place,
                        fmt::format("there is already a material {}; 'match' changes it",
                                    in_quotes(material.name)));
        material.exitance.assign(3, 0.0);
        if (!table.has("exitance") && !table.has("luminance")) table.require("reflectance");
        material.reflectance.assign(3, 0.0);
        change(material, table);
        scene_.add_material(std::move(material));
    }

    // Corners at the same place are one point, so that neighbours share it.
    std::uint32_t point(const Vec3& p) {
        const auto [found, fresh] = points_.try_emplace(std::array<double, 3>{p.x, p.y, p.z}, 0U);
        if (fresh) found->second = scene_.add_point(p);
        return found->second;
    }

    void polygon(const TomlTable& table) {
        table.require("corners");
        table.require("material");
        const std::string material = *table.text("material");
        const auto found =
            std::find_if(scene_.materials.begin(), scene_.materials.end(),
                         [&](const Material& candidate) { return candidate.name == material; });
        if (found == scene_.materials.end())
            throw Error(table.place("material"),
                        fmt::format("there is no material {}{}", in_quotes(material),
                                    suggestion(material, material_names())));
        const auto index = static_cast<std::uint32_t>(found - scene_.materials.begin());
        const std::string name = table.text("name").value_or(material);
        const auto [entry, fresh] = surfaces_.try_emplace({name, index}, 0U);
        if (fresh) {
            entry->second = scene_.add_surface(name, index);
            scene_.surfaces[entry->second].place = table.place();
        }
        const std::vector<Vec3> corners = *table.points("corners");
        if (corners.size() != 3 && corners.size() != 4)
            throw Error(table.place("corners"),
                        fmt::format("found {} corners, expected 3 or 4", corners.size()));
        Polygon polygon;
        for (std::size_t i = 0; i < corners.size(); ++i) polygon.corners[i] = point(corners[i]);
        polygon.surface = entry->second;
        polygon.patches = table.count("patches", 1, limits::patches).value_or(0);
        polygon.line = static_cast<std::uint32_t>(table.place().line);
        scene_.polygons.push_back(polygon);
    }

    void camera(const TomlTable& table) {
        table.require("eye");
        table.require("look_at");
        Camera camera;
        camera.name =
            table.text("name").value_or(fmt::format("camera {}", scene_.cameras.size() + 1));
        camera.eye = *table.vector("eye");
        camera.look_at = *table.vector("look_at");
        const Vec3 view = camera.look_at - camera.eye;
        if (!(length(view) > shortest))
            throw Error(table.place("look_at"),
                        "found the same point as 'eye', expected another one");
        camera.up = up_beside(table, normalized(view));
        camera.fov_y = table.number("fov", 0.01, 179).value_or(45);
        camera.aspect = table.number("aspect", 1e-3, 1e3);
        for (const Camera& other : scene_.cameras)
            if (other.name == camera.name)
                throw Error(table.place("name"),
                            fmt::format("there is already a camera {}", in_quotes(camera.name)));
        scene_.cameras.push_back(std::move(camera));
    }

    void grid(const TomlTable& table) {
        for (const char* key : {"origin", "u", "v"}) table.require(key);
        SensorGrid grid;
        grid.name = table.text("name").value_or(fmt::format("grid {}", scene_.grids.size() + 1));
        grid.origin = *table.vector("origin");
        grid.u = *table.vector("u");
        grid.v = *table.vector("v");
        divide(table, grid);
        const Vec3 across = cross(grid.u, grid.v);
        if (!table.has("normal") && !(length(across) > 0))
            throw Error(table.place("v"), "found 'v' along 'u', expected another direction");
        grid.normal = direction(table, "normal", normalized(across));
        scene_.grids.push_back(std::move(grid));
    }

    // Columns and rows, by number or by the distance of neighbours, inside a margin.
    static void divide(const TomlTable& table, SensorGrid& grid) {
        const double a = length(grid.u), b = length(grid.v);
        if (const auto margin = table.number("margin", 0, farthest)) {
            if (!(2 * *margin < std::min(a, b)))
                table.refuse("margin", "less than half of 'u' and 'v'");
            grid.origin += grid.u * (*margin / a) + grid.v * (*margin / b);
            grid.u = grid.u * (1 - 2 * *margin / a);
            grid.v = grid.v * (1 - 2 * *margin / b);
        }
        if (const auto spacing = table.number("spacing", shortest, farthest)) {
            for (const char* key : {"columns", "rows"})
                if (table.has(key))
                    throw Error(
                        table.place(key),
                        fmt::format("found both 'spacing' and '{}', expected one of them", key));
            const auto count = [&](double side) {
                const double n = std::max(1.0, std::round(side / *spacing));
                if (n > 10000) table.refuse("spacing", "at most 10000 points along each side");
                return static_cast<std::uint32_t>(n);
            };
            grid.columns = count(length(grid.u)), grid.rows = count(length(grid.v));
            return;
        }
        for (const char* key : {"columns", "rows"}) table.require(key);
        grid.columns = *table.count("columns", 1, 10000);
        grid.rows = *table.count("rows", 1, 10000);
    }

    // [[scenes]]: a name, and factors by the names of light groups.
    void light_scene(const Place& place, const std::vector<TomlTable::Scalar>& entries) {
        LightScene out;
        out.place = place;
        std::vector<std::string> known;
        for (const Grouping grouping : {Grouping::file, Grouping::luminaire, Grouping::material})
            for (const LightGroup& group : make_groups(scene_, grouping).groups)
                known.push_back(group.name);
        for (const TomlTable::Scalar& entry : entries) {
            if (entry.name == "name") {
                out.name = as_utf8(entry.value);
                continue;
            }
            if (std::find(known.begin(), known.end(), entry.name) == known.end())
                throw Error(entry.place,
                            fmt::format("there is no light group {}{}", in_quotes(entry.name),
                                        suggestion(entry.name, known)));
            double factor = 0;
            const char* end = entry.value.data() + entry.value.size();
            const auto [rest, failure] = std::from_chars(entry.value.data(), end, factor);
            if (failure != std::errc{} || rest != end || !(factor >= 0 && factor <= 1e6))
                throw Error(entry.place, fmt::format("{}: found {}, expected a factor from 0 up",
                                                     entry.name, in_quotes(entry.value)));
            out.factors[entry.name] = factor;
        }
        if (out.name.empty()) throw Error(place, "[[scenes]] has no 'name'");
        for (const LightScene& other : scene_.light_scenes)
            if (other.name == out.name)
                throw Error(place, fmt::format("there is already a scene {}", in_quotes(out.name)));
        scene_.light_scenes.push_back(std::move(out));
    }

    std::filesystem::path path_;
    TomlTable root_;
    const ReadGeometry& read_geometry_;
    const ReadOptions& options_;
    std::uint64_t most_polygons_;
    Scene scene_;
    std::optional<Quantity> quantity_;
    std::map<std::array<double, 3>, std::uint32_t> points_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> surfaces_;
};

}  // namespace

Scene parse_project(const std::filesystem::path& path, std::string_view text,
                    const ReadGeometry& read_geometry, const ReadOptions& options) {
    return ProjectReader(path, text, read_geometry, options).read();
}

}  // namespace exitance
