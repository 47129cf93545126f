// SPDX-License-Identifier: Apache-2.0
#include "truth/cornell_box.h"

#include <numbers>

namespace exitance::truth {

namespace {

constexpr double mm = 1e-3;
constexpr double X = 552.8, Y = 548.8, Z = 559.2;

/// Adds a quadrilateral; corners in mm, counter-clockwise from the front.
void add(Scene& scene, std::uint32_t surface, const std::array<Vec3, 4>& corners) {
    Polygon polygon;
    polygon.surface = surface;
    for (std::size_t i = 0; i < 4; ++i) polygon.corners[i] = scene.add_point(corners[i] * mm);
    scene.polygons.push_back(polygon);
}

/// A top face and four walls down to the floor; `top` counter-clockwise from above.
void add_block(Scene& scene, std::uint32_t surface, const std::array<Vec3, 4>& top) {
    add(scene, surface, top);
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 a = top[i], b = top[(i + 1) % 4];
        add(scene, surface, {a, {a.x, 0, a.z}, {b.x, 0, b.z}, b});
    }
}

std::uint32_t add_material(Scene& scene, const char* name, const Spectrum& reflectance,
                           const Spectrum& radiance = {0, 0, 0}) {
    Material material;
    material.name = name;
    material.reflectance = reflectance;
    for (const double L : radiance) material.exitance.push_back(std::numbers::pi * L);
    return scene.add_material(material);
}

}  // namespace

Scene cornell_box() {
    Scene scene;
    scene.title = "Cornell box";
    scene.quantity = Quantity::radiometric;
    const auto white = add_material(scene, "white", {.725, .71, .68});
    const auto red = add_material(scene, "red", {.63, .065, .05});
    const auto green = add_material(scene, "green", {.14, .45, .091});
    const auto light = add_material(scene, "light", {0, 0, 0}, {17, 12, 4});

    add(scene, scene.add_surface("floor", white), {{{0, 0, 0}, {0, 0, Z}, {X, 0, Z}, {X, 0, 0}}});
    add(scene, scene.add_surface("ceiling", white), {{{0, Y, 0}, {X, Y, 0}, {X, Y, Z}, {0, Y, Z}}});
    add(scene, scene.add_surface("back", white), {{{0, 0, Z}, {0, Y, Z}, {X, Y, Z}, {X, 0, Z}}});
    add(scene, scene.add_surface("left", red), {{{X, 0, 0}, {X, 0, Z}, {X, Y, Z}, {X, Y, 0}}});
    add(scene, scene.add_surface("right", green), {{{0, 0, 0}, {0, Y, 0}, {0, Y, Z}, {0, 0, Z}}});
    add_block(scene, scene.add_surface("short_block", white),
              {{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}});
    add_block(scene, scene.add_surface("tall_block", white),
              {{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}});
    add(scene, scene.add_surface("lamp", light),
        {{{213, Y - .1, 227}, {343, Y - .1, 227}, {343, Y - .1, 332}, {213, Y - .1, 332}}});
    scene.cameras.push_back(
        {"front", Vec3(278, 273, -800) * mm, Vec3(278, 273, 0) * mm, {0, 1, 0}, 39.3, 1.0, {}, {}});
    scene.grids.push_back({"floor", {}, {0, 0, Z * mm}, {X * mm, 0, 0}, {0, 1, 0}, 64, 64});
    scene.grids.push_back(
        {"back", {0, 0, Z * mm}, {0, Y * mm, 0}, {X * mm, 0, 0}, {0, 0, -1}, 64, 64});
    return scene;
}

}  // namespace exitance::truth
