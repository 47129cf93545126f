// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/scene.h"

#include <algorithm>

#include "exitance/math/polygon.h"

namespace exitance {

std::string exitance_unit(Quantity quantity) {
    switch (quantity) {
        case Quantity::unitless:
            return "";
        case Quantity::radiometric:
            return "W/m²";
        case Quantity::photometric:
            return "lm/m²";
    }
    return "";
}

std::string irradiance_unit(Quantity quantity) {
    return quantity == Quantity::photometric ? "lx" : exitance_unit(quantity);
}

std::string flux_unit(Quantity quantity) {
    switch (quantity) {
        case Quantity::unitless:
            return "";
        case Quantity::radiometric:
            return "W";
        case Quantity::photometric:
            return "lm";
    }
    return "";
}

namespace {

bool any_positive(const Spectrum& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v > 0; });
}

}  // namespace

bool Material::emits() const {
    return any_positive(exitance);
}

double Material::clear_transmittance() const {
    return transmittance.empty() ? 0.0 : std::clamp(luminance(transmittance), 0.0, 1.0);
}

bool Material::transmits() const {
    return any_positive(transmittance) || any_positive(diffuse_transmittance);
}

std::array<Vec3, 4> Scene::corners(const Polygon& polygon) const {
    std::array<Vec3, 4> out;
    for (std::uint32_t i = 0; i < polygon.size(); ++i) out[i] = points[polygon.corners[i]];
    return out;
}

double Scene::area(const Polygon& polygon) const {
    const auto c = corners(polygon);
    return exitance::area({c.data(), polygon.size()});
}

double Scene::area() const {
    double sum = 0;
    for (const Polygon& polygon : polygons) sum += area(polygon);
    return sum;
}

Vec3 Scene::normal(const Polygon& polygon) const {
    const auto c = corners(polygon);
    return unit_normal({c.data(), polygon.size()});
}

Box Scene::bounds() const {
    Box box;
    for (const Polygon& polygon : polygons)
        for (const std::uint32_t i : polygon.indices()) box.add(points[i]);
    return box;
}

std::string Scene::label(std::uint32_t surface) const {
    const std::string& name = surfaces[surface].name;
    const std::string& material = materials[surfaces[surface].material].name;
    return "'" + name + "'" + (material == name ? "" : " (" + material + ")");
}

std::uint32_t Scene::add_point(const Vec3& point, const Vec3& normal) {
    points.push_back(point);
    normals.push_back(normal);
    return static_cast<std::uint32_t>(points.size() - 1);
}

void Scene::set_texture_coordinates(std::uint32_t point, const TextureCoordinates& coordinates) {
    if (texture_coordinates.size() <= point) texture_coordinates.resize(points.size());
    texture_coordinates[point] = coordinates;
}

std::uint32_t Scene::add_material(Material material) {
    materials.push_back(std::move(material));
    return static_cast<std::uint32_t>(materials.size() - 1);
}

std::uint32_t Scene::add_surface(std::string name, std::uint32_t material) {
    surfaces.push_back({std::move(name), material, false, {}});
    return static_cast<std::uint32_t>(surfaces.size() - 1);
}

}  // namespace exitance
