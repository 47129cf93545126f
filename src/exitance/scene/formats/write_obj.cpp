// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ and MTL.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/write_losses.h"
#include "exitance/scene/formats/write_scene.h"

namespace exitance {

namespace {

std::string bands(const Spectrum& s, double factor = 1) {
    return fmt::format("{} {} {}", s[0] * factor, s[1] * factor, s[2] * factor);
}

// Kd d is reflected and 1 − d goes through, whatever its colour.
void write_material(std::ostream& out, const Material& m, const std::string& name,
                    std::size_t& coloured) {
    const double through = m.transmittance.empty() ? 0 : luminance(m.transmittance);
    const bool even = std::all_of(m.transmittance.begin(), m.transmittance.end(),
                                  [&](double t) { return std::abs(t - through) < 1e-9; });
    if (!even) ++coloured;
    const double opacity = std::max(0.0, 1 - through);
    Spectrum diffuse = m.reflectance;
    for (double& band : diffuse) band = opacity > 0 ? std::min(1.0, band / opacity) : 0;
    out << fmt::format("\nnewmtl {}\nKd {}\nKe {}\nd {}\n", name, bands(diffuse), bands(m.exitance),
                       opacity);
    if (m.refractive_index) out << fmt::format("Ni {}\n", *m.refractive_index);
}

}  // namespace

std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path) {
    Carries carries;
    carries.one_sided = carries.two_sided_emission = false;
    carries.transmittance = true;
    std::vector<std::string> lost = losses(scene, carries);
    emission_factor(scene, Quantity::unitless, lost);
    const auto materials = material_words(scene, lost);
    const auto surfaces = surface_words(scene, lost);
    std::filesystem::path library = path;
    library.replace_extension(".mtl");
    std::size_t coloured = 0;
    write_atomically(library, [&](std::ostream& out) {
        out << "# made by exitance; Ke is the exitance, without a unit\n";
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            write_material(out, scene.materials[m], materials[m], coloured);
    });
    if (coloured > 0)
        lost.push_back(
            fmt::format("{} materials lose the colour of their transmittance", coloured));
    write_atomically(path, [&](std::ostream& out) {
        out << "# made by exitance; metres\nmtllib " << library.filename().string() << "\n";
        for (const Vec3& p : scene.points) out << fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        std::vector<std::size_t> normal(scene.points.size(), 0);
        std::size_t normals = 0;
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            const Vec3& n = scene.normals[i];
            if (n == Vec3{}) continue;
            out << fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
            normal[i] = ++normals;
        }
        const auto by_surface = polygons_by_surface(scene);
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
            if (by_surface[s].empty()) continue;
            out << fmt::format("o {}\nusemtl {}\n", surfaces[s],
                               materials[scene.surfaces[s].material]);
            for (const Polygon* polygon : by_surface[s]) {
                out << "f";
                const auto corners = polygon->indices();
                const bool smooth = std::all_of(corners.begin(), corners.end(),
                                                [&](std::uint32_t i) { return normal[i] > 0; });
                for (const std::uint32_t i : corners)
                    out << (smooth ? fmt::format(" {}//{}", i + 1, normal[i])
                                   : fmt::format(" {}", i + 1));
                out << "\n";
            }
        }
    });
    return lost;
}

}  // namespace exitance
