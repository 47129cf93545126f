// SPDX-License-Identifier: Apache-2.0
// Radiance scene description.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/write_losses.h"
#include "exitance/scene/formats/write_scene.h"

namespace exitance {

namespace {

double of(const Spectrum& s, std::size_t band) {
    return s.empty() ? 0 : s[band];
}

double whole(const Spectrum& s) {
    return s.empty() ? 0 : luminance(s);
}

/// Ward's materials: colour c, specularity s, transmission t, of which ts straight. What is not
/// mirrored, c (1 − s), is reflected (1 − t), spread behind (t (1 − ts)) or goes through (t ts).
struct WardMaterial {
    Spectrum colour{0, 0, 0};
    double specularity = 0, transmission = 0, straight = 0;
    bool metal = false, exact = true;
};

WardMaterial ward(const Material& m) {
    WardMaterial out;
    const double through = whole(m.transmittance) + whole(m.diffuse_transmittance);
    const double body = whole(m.reflectance) + through;
    if (through > 0) {
        out.transmission = through / body;
        out.straight = whole(m.transmittance) / through;
    }
    const double mirrored = whole(m.specular);
    const bool grey =
        m.specular.empty() || (m.specular[0] == m.specular[1] && m.specular[1] == m.specular[2]);
    out.metal = !grey && through == 0;
    out.specularity = out.metal ? mirrored / (mirrored + body) : mirrored;
    for (std::size_t b = 0; b < 3; ++b) {
        const double rest =
            m.reflectance[b] + of(m.transmittance, b) + of(m.diffuse_transmittance, b);
        out.colour[b] = out.metal              ? rest + m.specular[b]
                        : out.specularity >= 1 ? 0
                                               : rest / (1 - out.specularity);
        out.colour[b] = std::min(1.0, out.colour[b]);
        const double kept = out.colour[b] * (1 - out.specularity);
        const auto differs = [&](double a, double c) { return std::abs(a - c) > 1e-6; };
        if (differs(kept * (1 - out.transmission), m.reflectance[b]) ||
            differs(kept * out.transmission * out.straight, of(m.transmittance, b)) ||
            differs(out.specularity * (out.metal ? out.colour[b] : 1), of(m.specular, b)))
            out.exact = false;
    }
    return out;
}

bool write_material(std::ostream& out, const Material& m, const std::string& name, double factor) {
    if (m.emits()) {
        // Exitance M = π L (Lambert).
        const double f = factor / std::numbers::pi;
        out << fmt::format("\nvoid light {}\n0\n0\n3 {} {} {}\n", name, m.exitance[0] * f,
                           m.exitance[1] * f, m.exitance[2] * f);
        return true;
    }
    const WardMaterial w = ward(m);
    const Spectrum& c = w.colour;
    if (w.transmission > 0)
        out << fmt::format("\nvoid trans {}\n0\n0\n7 {} {} {} {} {} {} {}\n", name, c[0], c[1],
                           c[2], w.specularity, m.roughness, w.transmission, w.straight);
    else
        out << fmt::format("\nvoid {} {}\n0\n0\n5 {} {} {} {} {}\n", w.metal ? "metal" : "plastic",
                           name, c[0], c[1], c[2], w.specularity, m.roughness);
    return w.exact;
}

}  // namespace

std::vector<std::string> write_rad(const Scene& scene, const std::filesystem::path& path) {
    Carries carries;
    carries.shading_normals = carries.one_sided = carries.two_sided_emission = false;
    carries.emitters_reflect = false;
    carries.specular = carries.transmittance = carries.diffuse_transmittance = true;
    std::vector<std::string> lost = losses(scene, carries);
    const double factor = emission_factor(scene, Quantity::radiometric, lost);
    const auto materials = material_words(scene, lost);
    const auto surfaces = surface_words(scene, lost);
    std::size_t inexact = 0;
    write_atomically(path, [&](std::ostream& out) {
        out << "# made by exitance\n";
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            inexact += !write_material(out, scene.materials[m], materials[m], factor);
        const auto by_surface = polygons_by_surface(scene);
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            for (std::size_t k = 0; k < by_surface[s].size(); ++k) {
                const Polygon& polygon = *by_surface[s][k];
                out << fmt::format("\n{} polygon {}.{}\n0\n0\n{}\n",
                                   materials[scene.surfaces[s].material], surfaces[s], k + 1,
                                   3 * polygon.size());
                for (const std::uint32_t i : polygon.indices()) {
                    const Vec3& p = scene.points[i];
                    out << fmt::format("\t{} {} {}\n", p.x, p.y, p.z);
                }
            }
    });
    if (inexact > 0)
        lost.push_back(
            fmt::format("{} materials keep the luminance, but not all of the colour, of "
                        "what they mirror or let through",
                        inexact));
    return lost;
}

}  // namespace exitance
