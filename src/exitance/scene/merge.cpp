// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/merge.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "exitance/scene/builtin_photometry.h"

namespace exitance {

namespace {

void convert_emission(Scene& part, Quantity wanted) {
    const Place* first = nullptr;
    for (const Material& material : part.materials)
        if (!first && material.emits()) first = &material.place;
    if (!first && !part.luminaires.empty()) first = &part.luminaires.front().place;
    if (!first && !part.distant.empty()) first = &part.distant.front().place;
    if (!first || part.quantity == wanted) return;
    double factor = 1;
    if (part.quantity == Quantity::photometric && wanted == Quantity::radiometric)
        factor = 1 / luminous_efficacy;
    if (part.quantity == Quantity::radiometric && wanted == Quantity::photometric)
        factor = luminous_efficacy;
    const auto name = [](Quantity quantity) {
        const std::string unit = exitance_unit(quantity);
        return unit.empty() ? std::string("numbers without a unit") : unit;
    };
    part.warnings.push_back(
        {*first, fmt::format("emission in {} is taken as {}{}", name(part.quantity), name(wanted),
                             factor == 1 ? "" : fmt::format(" at {} lm/W", luminous_efficacy))});
    for (Material& material : part.materials) {
        for (double& e : material.exitance) e *= factor;
        for (double& e : material.exitance_pattern.factor) e *= factor;
    }
    for (Luminaire& luminaire : part.luminaires) luminaire.multiplier *= factor;
    for (DistantLight& light : part.distant) light.irradiance *= factor, light.strength *= factor;
}

// Turned and moved; what shines keeps its own size and flux.
void place(Luminaire& luminaire, const Transform& placing) {
    luminaire.position = placing.point(luminaire.position);
    luminaire.c0 = normalized(placing.vector(luminaire.c0));
    const Vec3 nadir = placing.vector(luminaire.nadir);
    luminaire.nadir = normalized(nadir - luminaire.c0 * dot(nadir, luminaire.c0));
    if (placing.determinant() < 0)
        luminaire.photometry = std::make_shared<const Photometry>(mirrored(*luminaire.photometry));
}

void place(DistantLight& light, const Transform& placing) {
    const auto turned = [&](const Vec3& v) { return normalized(placing.vector(v)); };
    light.direction = turned(light.direction);
    light.model.sun = turned(light.model.sun);
    if (!light.map) return;
    // What the cells of the new axes look at in the old ones.
    RadianceMap map = *light.map;
    const Vec3 x = turned({1, 0, 0}), y = turned({0, 1, 0}), z = turned({0, 0, 1});
    const std::uint32_t n = map.side();
    for (std::uint32_t i = 0; i < 2 * n * n; ++i) {
        const Vec3 d = direction_of({i >= n * n, (i % n + 0.5) / n, (i / n % n + 0.5) / n});
        const auto rgb = light.map->radiance({dot(d, x), dot(d, y), dot(d, z)});
        for (std::size_t b = 0; b < 3; ++b) map.cells[3 * i + b] = static_cast<float>(rgb[b]);
    }
    light.map = std::make_shared<const RadianceMap>(std::move(map));
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

void merge(Scene& scene, Scene part, const Transform& placing) {
    convert_emission(part, scene.quantity);
    const auto points = static_cast<std::uint32_t>(scene.points.size());
    const auto surfaces = static_cast<std::uint32_t>(scene.surfaces.size());
    const auto materials = static_cast<std::uint32_t>(scene.materials.size());
    for (std::size_t i = 0; i < part.points.size(); ++i)
        scene.add_point(placing.point(part.points[i]), normalized(placing.normal(part.normals[i])));
    for (std::uint32_t i = 0; i < part.texture_coordinates.size(); ++i)
        scene.set_texture_coordinates(points + i, part.texture_coordinates[i]);
    for (Polygon& polygon : part.polygons) {
        for (std::uint32_t& corner : polygon.corners)
            if (corner != Polygon::none) corner += points;
        polygon.surface += surfaces;
    }
    for (Surface& surface : part.surfaces) surface.material += materials;
    const double scale = std::cbrt(std::abs(placing.determinant()));
    for (Camera& camera : part.cameras) {
        camera.eye = placing.point(camera.eye);
        camera.look_at = placing.point(camera.look_at);
        camera.up = normalized(placing.vector(camera.up));
        if (camera.near) *camera.near *= scale;
        if (camera.far) *camera.far *= scale;
    }
    for (SensorGrid& grid : part.grids) {
        grid.origin = placing.point(grid.origin);
        grid.u = placing.vector(grid.u);
        grid.v = placing.vector(grid.v);
        grid.normal = normalized(placing.normal(grid.normal));
    }
    for (Luminaire& luminaire : part.luminaires) place(luminaire, placing);
    const auto of = static_cast<std::uint32_t>(scene.form_factors.surfaces.size());
    for (FormFactorSurface& asked : part.form_factors.surfaces) {
        asked.surface += surfaces;
        if (asked.base) *asked.base += of;
        if (asked.combine) *asked.combine += of;
    }
    append(scene.form_factors.surfaces, part.form_factors.surfaces);
    append(scene.form_factors.options, part.form_factors.options);
    for (DistantLight& light : part.distant) place(light, placing);
    append(scene.polygons, part.polygons);
    append(scene.surfaces, part.surfaces);
    append(scene.materials, part.materials);
    append(scene.luminaires, part.luminaires);
    append(scene.distant, part.distant);
    append(scene.light_scenes, part.light_scenes);
    append(scene.cameras, part.cameras);
    append(scene.grids, part.grids);
    append(scene.settings, part.settings);
    append(scene.warnings, part.warnings);
    append(scene.notes, part.notes);
}

}  // namespace exitance
