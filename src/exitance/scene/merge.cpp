// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/merge.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

namespace exitance {

namespace {

void convert_emission(Scene& part, Quantity wanted) {
    const Material* first = nullptr;
    for (const Material& material : part.materials)
        if (!first && material.emits()) first = &material;
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
        {first->place,
         fmt::format("emission in {} is taken as {}{}", name(part.quantity), name(wanted),
                     factor == 1 ? "" : fmt::format(" at {} lm/W", luminous_efficacy))});
    for (Material& material : part.materials)
        for (double& e : material.exitance) e *= factor;
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
    append(scene.polygons, part.polygons);
    append(scene.surfaces, part.surfaces);
    append(scene.materials, part.materials);
    append(scene.cameras, part.cameras);
    append(scene.grids, part.grids);
    append(scene.settings, part.settings);
    append(scene.warnings, part.warnings);
}

}  // namespace exitance
