// SPDX-License-Identifier: Apache-2.0
// Materials and Geometry Format 2.
#include <fmt/format.h>

#include <ostream>

#include "exitance/run/atomic_file.h"
#include "exitance/scene/cie_observer.h"
#include "exitance/scene/formats/write_losses.h"
#include "exitance/scene/formats/write_scene.h"

namespace exitance {

namespace {

// A share of light and the chromaticity that colours it.
void write_share(std::ostream& out, const char* entity, const Spectrum& value,
                 const std::string& more = "", double factor = 1) {
    const double y = value.empty() ? 0 : luminance(value);
    if (!(y > 0)) return;
    const Xyz colour = xyz_of_rgb(value);
    const double sum = colour.x + colour.y + colour.z;
    out << fmt::format("\tc\n\t\tcxy {} {}\n\t{} {}{}\n", colour.x / sum, colour.y / sum, entity,
                       y * factor, more);
}

void write_material(std::ostream& out, const Material& m, const std::string& name, double factor) {
    out << fmt::format("m {} =\n\tsides {}\n", name, m.two_sided ? 2 : 1);
    const std::string rough = fmt::format(" {}", m.roughness);
    write_share(out, "rd", m.reflectance);
    write_share(out, "td", m.diffuse_transmittance);
    write_share(out, "rs", m.specular, rough);
    write_share(out, "ts", m.transmittance, m.specular.empty() ? rough : " 0");
    write_share(out, "ed", m.exitance, "", factor);
    if (m.refractive_index) out << fmt::format("\tir {} 0\n", *m.refractive_index);
}

// "room/table" stands in two objects.
std::vector<std::string> parts_of(const std::string& name) {
    std::vector<std::string> out;
    for (std::size_t at = 0; at <= name.size();) {
        const std::size_t end = std::min(name.find('/', at), name.size());
        if (end > at) out.push_back(name.substr(at, end - at));
        at = end + 1;
    }
    return out;
}

}  // namespace

std::vector<std::string> write_mgf(const Scene& scene, const std::filesystem::path& path) {
    Carries carries;
    carries.specular = carries.transmittance = carries.diffuse_transmittance = true;
    std::vector<std::string> lost = losses(scene, carries);
    const double factor = emission_factor(scene, Quantity::photometric, lost);
    const auto materials = material_words(scene, lost);
    const auto surfaces = surface_words(scene, lost);
    write_atomically(path, [&](std::ostream& out) {
        out << "# made by exitance\n";
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            write_material(out, scene.materials[m], materials[m], factor);
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            const Vec3 &p = scene.points[i], &n = scene.normals[i];
            out << fmt::format("v v{} =\n\tp {} {} {}\n", i, p.x, p.y, p.z);
            if (n != Vec3{}) out << fmt::format("\tn {} {} {}\n", n.x, n.y, n.z);
        }
        const auto by_surface = polygons_by_surface(scene);
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
            if (by_surface[s].empty()) continue;
            const auto parts = parts_of(surfaces[s]);
            for (const std::string& part : parts) out << "o " << part << "\n";
            out << "m " << materials[scene.surfaces[s].material] << "\n";
            for (const Polygon* polygon : by_surface[s]) {
                out << "f";
                for (const std::uint32_t i : polygon->indices()) out << " v" << i;
                out << "\n";
            }
            for (std::size_t i = 0; i < parts.size(); ++i) out << "o\n";
        }
    });
    return lost;
}

}  // namespace exitance
