// SPDX-License-Identifier: Apache-2.0
#include "scene_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/scene/formats/general_geometry.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/spectrum.h"
#include "exitance/scene/texture_map.h"
#include "human_number.h"

namespace exitance::cli {

namespace {

constexpr std::size_t most_lines = 40;  // of materials, groups or problems that are listed

std::string format_name(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".toml") return "lighting project";
    if (extension == ".gltf" || extension == ".glb") return "glTF 2.0";
    if (extension == ".mgf") return "MGF";
    if (extension == ".rad") return "Radiance";
    if (extension == ".vs3") return "View3D";
    if (is_general_geometry(file)) return "geometry by Assimp";
    return extension == ".geom" ? "AFIT geometry" : "scene";
}

std::string quantity_text(Quantity quantity) {
    if (quantity == Quantity::photometric)
        return "photometric: exitance in lm/m², irradiance in lx";
    if (quantity == Quantity::radiometric) return "radiometric: exitance and irradiance in W/m²";
    return "without a unit of light";
}

std::string point_text(const Vec3& p) {
    return fmt::format("({}, {}, {})", human_number(p.x), human_number(p.y), human_number(p.z));
}

// Altitude, and azimuth from −z over +x, or where z is up from +y.
std::string angles_text(const Vec3& direction, const Vec3& up) {
    const auto angles = sky_angles(direction, up);
    if (!angles) return "";
    return fmt::format(" ({:.1f}° {} the horizon, azimuth {:.1f}° from {} over +x)",
                       std::abs(angles->altitude), angles->altitude < 0 ? "below" : "above",
                       angles->azimuth, up.y > 0.5 ? "−z" : "+y");
}

std::string bands_text(const Scene& scene, const Spectrum& value) {
    if (std::all_of(value.begin(), value.end(), [&](double v) { return v == value[0]; })) return "";
    std::string out;
    for (std::size_t b = 0; b < value.size(); ++b)
        out += fmt::format("{}{} {}", b > 0 ? ", " : "", scene.bands[b], human_number(value[b]));
    return " (" + out + ")";
}

}  // namespace

std::optional<SkyAngles> sky_angles(const Vec3& direction, const Vec3& up) {
    constexpr double degree = std::numbers::pi / 180;
    const Vec3 y{0, 1, 0}, z{0, 0, 1};
    if (up != y && up != z) return std::nullopt;
    const double north = up == y ? -direction.z : direction.y;
    const double azimuth = std::atan2(direction.x, north) / degree;
    return SkyAngles{std::asin(std::clamp(dot(direction, up), -1.0, 1.0)) / degree,
                     azimuth < 0 ? azimuth + 360 : azimuth};
}

std::string scene_text(const LightScene& scene) {
    std::string out = fmt::format("Scene {}:", scene.name);
    const char* sign = " ";
    for (const auto& [group, factor] : scene.factors) {
        out += fmt::format("{}{} {:g}", sign, group, factor);
        sign = ", ";
    }
    return out + (scene.factors.empty() ? " as it is\n" : "\n");
}

SceneReport::SceneReport(const Scene& scene, std::vector<Problem> problems,
                         std::filesystem::path file)
    : scene_(scene), problems_(std::move(problems)), file_(std::move(file)) {
    problems_.insert(problems_.begin(), scene.warnings.begin(), scene.warnings.end());
    for (const Material& material : scene.materials) materials_.push_back({&material, 0, 0});
    const LightGroups groups = make_groups(scene, Grouping::file);
    for (const LightGroup& group : groups.groups) groups_.push_back({.name = group.name});
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.materials[scene.surfaces[s].material].emits())
            ++groups_[groups.group_of_surface[s]].surfaces;
    for (const Polygon& polygon : scene.polygons) {
        const double area = scene.area(polygon);
        area_ += area;
        ++(polygon.size() == 3 ? triangles_ : quads_);
        MaterialFacts& facts = materials_[scene.surfaces[polygon.surface].material];
        facts.area += area;
        ++facts.polygons;
        if (!facts.material->emits()) continue;
        const double emitting = area * (facts.material->two_sided ? 2 : 1);
        const double flux = emitting * luminance(mean_exitance(scene, polygon));
        LampFacts& lamp = groups_[groups.group_of_surface[polygon.surface]];
        lamp.area += emitting;
        lamp.flux += flux;
        flux_ += flux;
    }
    for (std::size_t l = 0; l < scene.luminaires.size(); ++l) {
        LampFacts& lamp = groups_[groups.group_of_luminaire[l]];
        const double flux = scene.luminaires[l].flux();
        lamp.flux += flux;
        flux_ += flux;
        ++lamp.luminaires;
    }
    for (const std::uint32_t group : groups.group_of_distant) ++groups_[group].distant;
    bounds_ = scene.bounds();
}

std::string SceneReport::text() const {
    return fmt::format("{}\n{}: {}, {}\n\n", scene_.title, file_.string(), format_name(file_),
                       quantity_text(scene_.quantity)) +
           notes_text() + geometry_text() + materials_text() + light_text() + views_text() +
           problems_text();
}

std::string SceneReport::notes_text() const {
    std::string out;
    for (const Problem& note : scene_.notes)
        out += fmt::format("{}: {}\n", note.place.text(), note.what);
    return out.empty() ? out : out + "\n";
}

std::string SceneReport::geometry_text() const {
    std::string out =
        fmt::format("Geometry: {}", plural(scene_.polygons.size(), "polygon", "polygons"));
    if (scene_.polygons.empty()) return out + "\n";
    if (triangles_ > 0 && quads_ > 0)
        out += fmt::format(" ({}, {})", plural(triangles_, "triangle", "triangles"),
                           plural(quads_, "quad", "quads"));
    else
        out += scene_.polygons.size() == 1 ? triangles_ > 0 ? ", a triangle" : ", a quad"
               : triangles_ > 0            ? ", all triangles"
                                           : ", all quads";
    out += fmt::format(", {}, {:.4g} m²\n", plural(scene_.surfaces.size(), "surface", "surfaces"),
                       area_);
    const Vec3 size = bounds_.size();
    return out + fmt::format("  {:.4g} × {:.4g} × {:.4g} m, from {} to {}\n", size.x, size.y,
                             size.z, point_text(bounds_.lower), point_text(bounds_.upper));
}

std::string SceneReport::materials_text() const {
    std::string out = fmt::format("\nMaterials: {}\n", scene_.materials.size());
    std::size_t width = 0;
    for (const MaterialFacts& facts : materials_)
        width = std::max(width, std::min<std::size_t>(facts.material->name.size(), 30));
    for (std::size_t i = 0; i < materials_.size(); ++i) {
        if (i == most_lines) {
            out += fmt::format("  … and {} more\n", materials_.size() - most_lines);
            break;
        }
        const Material& m = *materials_[i].material;
        out +=
            fmt::format("  {:<{}}  reflectance {:.3g}{}, {}", m.name, width,
                        luminance(m.reflectance), bands_text(scene_, m.reflectance),
                        materials_[i].polygons == 0 ? std::string("unused")
                                                    : fmt::format("{:.4g} m²", materials_[i].area));
        if (m.reflectance_pattern)
            out +=
                fmt::format(", texture of {} × {}", m.reflectance_pattern.texture->picture().width,
                            m.reflectance_pattern.texture->picture().height);
        if (m.two_sided) out += ", two-sided";
        if (!m.specular.empty() && luminance(m.specular) > 0)
            out += fmt::format(", mirrors {:.3g}", luminance(m.specular));
        if (luminance(m.transmittance) > 0)
            out += fmt::format(", transmits {:.3g}", luminance(m.transmittance));
        if (luminance(m.diffuse_transmittance) > 0)
            out += fmt::format(", transmits {:.3g} diffusely (taken as absorbed)",
                               luminance(m.diffuse_transmittance));
        if (m.emits())
            out +=
                fmt::format(", emits {}{}",
                            human_quantity(luminance(m.exitance), exitance_unit(scene_.quantity)),
                            bands_text(scene_, m.exitance)) +
                (m.exitance_pattern ? " on the mean of its texture" : "");
        if (m.reflectance_file) out += fmt::format(", reflectance file {}", *m.reflectance_file);
        out += "\n";
    }
    return out;
}

std::string SceneReport::light_text() const {
    if (flux_ <= 0 && scene_.distant.empty()) return "\nLight: none\n";
    const std::string unit = flux_unit(scene_.quantity);
    std::string out = fmt::format("\nLight: {}{}\n",
                                  flux_ > 0 ? human_quantity(flux_, unit) + " in all, from " : "",
                                  plural(groups_.size(), "light group", "light groups"));
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        if (i == most_lines) {
            out += fmt::format("  … and {} more\n", groups_.size() - most_lines);
            break;
        }
        const LampFacts& g = groups_[i];
        std::string from;
        const auto add = [&](const std::string& part) {
            from += (from.empty() ? "" : " and ") + part;
        };
        if (g.surfaces > 0)
            add(fmt::format("{:.4g} m² of {}", g.area, plural(g.surfaces, "surface", "surfaces")));
        if (g.luminaires > 0) add(plural(g.luminaires, "luminaire", "luminaires"));
        if (g.distant > 0) add("afar");
        out += fmt::format("  {}: {}from {}\n", g.name,
                           g.flux > 0 ? human_quantity(g.flux, unit) + " " : "", from);
    }
    return out + distant_text();
}

std::string SceneReport::distant_text() const {
    const std::string unit = irradiance_unit(scene_.quantity);
    std::string out;
    for (const DistantLight& light : scene_.distant) {
        if (light.kind == DistantLight::Kind::sky)
            out += fmt::format("Sky {}: {} on open ground\n", light.name,
                               human_quantity(horizontal_irradiance(light), unit));
        else
            out += fmt::format("Sun {}: {} across its rays, from {}{}, {:.3g}° wide\n", light.name,
                               human_quantity(light.irradiance, unit), point_text(light.direction),
                               angles_text(light.direction, scene_.up),
                               light.diameter * 180 / std::numbers::pi);
    }
    return out;
}

std::string SceneReport::views_text() const {
    std::string out = "\n";
    for (const Camera& c : scene_.cameras)
        out += fmt::format("Camera {}: from {} to {}, {:.4g}° high\n", c.name, point_text(c.eye),
                           point_text(c.look_at), c.fov_y);
    if (scene_.cameras.empty()) out += "No cameras.\n";
    for (const SensorGrid& g : scene_.grids)
        out += fmt::format("Grid {}: {} × {} points over {:.4g} × {:.4g} m, facing {}\n", g.name,
                           g.columns, g.rows, length(g.u), length(g.v), point_text(g.normal));
    for (const LightScene& s : scene_.light_scenes) out += scene_text(s);
    for (const Setting& s : scene_.settings)
        out += fmt::format("Setting {} = {}\n", s.name, s.value);
    return out;
}

std::string SceneReport::problems_text() const {
    if (problems_.empty()) return "\nNo problems found.\n";
    std::string out = fmt::format("\nProblems: {}\n", problems_.size());
    for (std::size_t i = 0; i < problems_.size(); ++i) {
        if (i == most_lines)
            return out + fmt::format("  … and {} more\n", problems_.size() - most_lines);
        const std::string place = problems_[i].place.text();
        out += fmt::format("  {}. {}{}{}\n", i + 1, place, place.empty() ? "" : ": ",
                           problems_[i].what);
    }
    return out;
}

}  // namespace exitance::cli
