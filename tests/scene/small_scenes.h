// SPDX-License-Identifier: Apache-2.0
// Scenes put together polygon by polygon.
#pragma once

#include <initializer_list>
#include <string>

#include "exitance/scene/scene.h"

namespace exitance::testing {

inline std::uint32_t add_surface(Scene& scene, const std::string& name, double reflectance = 0.5,
                                 double exitance = 0) {
    Material material;
    material.name = name;
    material.reflectance.assign(3, reflectance);
    material.exitance.assign(3, exitance);
    material.place = {"s.geom", 7, 3};
    const std::uint32_t made = scene.add_surface(name, scene.add_material(material));
    scene.surfaces[made].place = material.place;
    return made;
}

inline Polygon& add_polygon(Scene& scene, std::uint32_t surface,
                            std::initializer_list<Vec3> corners) {
    Polygon polygon;
    polygon.surface = surface;
    std::size_t i = 0;
    for (const Vec3& corner : corners) polygon.corners[i++] = scene.add_point(corner);
    scene.polygons.push_back(polygon);
    return scene.polygons.back();
}

/// A square of edge `size` at (x, y, z), facing +z, or −z if `turned`.
inline Polygon& add_square(Scene& scene, std::uint32_t surface, double x, double y, double z,
                           double size = 1, bool turned = false) {
    const Vec3 a{x, y, z}, b{x + size, y, z}, c{x + size, y + size, z}, d{x, y + size, z};
    if (turned) return add_polygon(scene, surface, {a, d, c, b});
    return add_polygon(scene, surface, {a, b, c, d});
}

}  // namespace exitance::testing
