// SPDX-License-Identifier: Apache-2.0
// AFIT geometry and display files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/write_losses.h"
#include "exitance/scene/formats/write_scene.h"

namespace exitance {

namespace {

std::string vector(const Vec3& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

}  // namespace

void write_afit_display(const AfitDisplay& d, std::ostream& out) {
    out << d.comment << "\neye " << vector(d.eye) << " lookat " << vector(d.look_at) << "\nup "
        << vector(d.up) << fmt::format("\nfovx {} fovy {}\n", d.fov_x, d.fov_y);
    if (d.near) out << fmt::format("near {}\n", *d.near);
    if (d.far) out << fmt::format("far {}\n", *d.far);
    out << fmt::format("xres {} yres {}\n", d.width, d.height);
    if (d.diameter) out << fmt::format("diameter {}\n", *d.diameter);
    if (d.ambient) out << fmt::format("ambient {}\n", *d.ambient ? 1 : 0);
    if (d.threshold) out << fmt::format("threshold {}\n", *d.threshold);
}

AfitDisplay display_of(const Camera& camera) {
    constexpr double pi = std::numbers::pi;
    AfitDisplay out;
    out.comment = camera.name;
    out.eye = camera.eye;
    out.look_at = camera.look_at;
    out.up = camera.up;
    out.fov_y = camera.fov_y;
    const double aspect = camera.aspect.value_or(static_cast<double>(out.width) / out.height);
    out.fov_x = 360 / pi * std::atan(aspect * std::tan(camera.fov_y * pi / 360));
    out.width =
        static_cast<std::uint32_t>(std::clamp(std::lround(aspect * out.height), 1L, 65536L));
    out.near = camera.near;
    out.far = camera.far;
    return out;
}

std::vector<std::string> write_afit(const Scene& scene, const std::filesystem::path& path) {
    Carries carries;
    carries.patches = true;
    carries.cameras = 1;
    carries.surface_names = carries.material_names = false;
    carries.two_sided_emission = false;
    const auto sides = [&](bool two) {
        return std::any_of(scene.materials.begin(), scene.materials.end(),
                           [&](const Material& m) { return m.two_sided == two && !m.emits(); });
    };
    const bool both_sides = sides(true);
    carries.one_sided = !both_sides;
    std::vector<std::string> lost = losses(scene, carries);
    emission_factor(scene, Quantity::unitless, lost);
    write_atomically(path, [&](std::ostream& out) {
        std::string title = scene.title;
        std::replace(title.begin(), title.end(), '\n', ' ');
        out << title << "\nccw " << (both_sides ? "nopurge" : "purge")
            << fmt::format("\npoints {} patches {} attributes {}\n", scene.points.size(),
                           scene.polygons.size(), scene.materials.size());
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            out << vector(scene.points[i]);
            if (scene.normals[i] != Vec3{}) out << " normal " << vector(scene.normals[i]);
            out << "\n";
        }
        for (const Polygon& polygon : scene.polygons) {
            out << polygon.size();
            for (const std::uint32_t i : polygon.indices()) out << " " << i + 1;
            out << fmt::format(" attribute {}", scene.surfaces[polygon.surface].material + 1);
            if (polygon.patches > 0) out << fmt::format(" patch {}", polygon.patches);
            out << "\n";
        }
        for (const Material& m : scene.materials) {
            const Spectrum &r = m.reflectance, &e = m.exitance;
            out << fmt::format("color {} {} {}", r[0], r[1], r[2]);
            if (m.emits()) out << fmt::format(" emit {} {} {}", e[0], e[1], e[2]);
            out << "\n";
        }
    });
    if (!scene.cameras.empty()) {
        std::filesystem::path display = path;
        display.replace_extension(".display");
        write_atomically(display, [&](std::ostream& out) {
            write_afit_display(display_of(scene.cameras[0]), out);
        });
    }
    return lost;
}

}  // namespace exitance
