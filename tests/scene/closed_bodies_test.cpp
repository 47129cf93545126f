// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/closed_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace exitance {
namespace {

// Six quads of one surface, fronts outside.
void add_box(Scene& scene, const Vec3& corner, double size, std::uint32_t surface, int faces = 6) {
    std::array<std::uint32_t, 8> p{};
    for (std::uint32_t i = 0; i < 8; ++i)
        p[i] =
            scene.add_point(corner + Vec3{i & 1U ? size : 0, i & 2U ? size : 0, i & 4U ? size : 0});
    const std::array<std::array<std::uint32_t, 4>, 6> quads{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (int f = 0; f < faces; ++f) {
        Polygon polygon;
        for (std::size_t c = 0; c < 4; ++c)
            polygon.corners[c] = p[quads[static_cast<std::size_t>(f)][c]];
        polygon.surface = surface;
        scene.polygons.push_back(polygon);
    }
}

Material two_sided(const std::string& name, double exitance = 0) {
    Material material;
    material.name = name;
    material.reflectance = Spectrum(3, 0.5);
    material.exitance = Spectrum(3, exitance);
    material.two_sided = true;
    return material;
}

// A room of two-sided walls with fronts outside, and a box in it.
Scene room_with_box(double exitance = 0, int faces = 6, double lift = 1) {
    Scene scene;
    const auto walls = scene.add_surface("walls", scene.add_material(two_sided("paint")));
    const auto box = scene.add_surface("box", scene.add_material(two_sided("wood", exitance)));
    add_box(scene, {0, 0, 0}, 10, walls);
    add_box(scene, {4, 4, lift}, 1, box, faces);
    return scene;
}

std::size_t two_sided_polygons(const Scene& scene) {
    return static_cast<std::size_t>(
        std::count_if(scene.polygons.begin(), scene.polygons.end(),
                      [&](const Polygon& p) { return scene.material(p).two_sided; }));
}

TEST(ClosedBodies, ABoxInARoomBecomesOneSidedAndTheRoomDoesNot) {
    Scene scene = room_with_box();
    close_bodies(scene);
    EXPECT_EQ(two_sided_polygons(scene), 6U);
    for (const Polygon& polygon : scene.polygons)
        EXPECT_EQ(scene.material(polygon).two_sided,
                  scene.surfaces[polygon.surface].name == "walls");
    EXPECT_EQ(scene.materials.size(), 2U);  // what is not used any more is gone
    EXPECT_EQ(scene.surfaces.size(), 2U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(ClosedBodies, EmissionIntoABodyIsTold) {
    Scene scene = room_with_box(100);
    close_bodies(scene);
    EXPECT_EQ(two_sided_polygons(scene), 6U);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].what.find("'wood'"), std::string::npos);
    EXPECT_NE(scene.warnings[0].what.find("6 polygons"), std::string::npos);
}

TEST(ClosedBodies, OpenBoxesStayAsTheyAre) {
    Scene scene = room_with_box(100, 5);
    close_bodies(scene);
    EXPECT_EQ(two_sided_polygons(scene), 11U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(ClosedBodies, GlassAndShadesAroundALampStayAsTheyAre) {
    Scene glass = room_with_box();
    glass.materials[1].transmittance = Spectrum(3, 0.9);
    close_bodies(glass);
    EXPECT_EQ(two_sided_polygons(glass), 12U);

    Scene shade = room_with_box();
    const auto lamp = shade.add_surface("lamp", shade.add_material(two_sided("lamp", 5)));
    add_box(shade, {4.4, 4.4, 1.4}, 0.2, lamp);
    close_bodies(shade);
    EXPECT_EQ(two_sided_polygons(shade), 12U);  // the lamp in the shade is closed, the shade not
}

TEST(ClosedBodies, FrontsInsideStayTwoSided) {
    Scene scene = room_with_box();
    for (std::size_t p = 6; p < 12; ++p)
        std::reverse(scene.polygons[p].corners.begin(), scene.polygons[p].corners.end());
    close_bodies(scene);
    EXPECT_EQ(two_sided_polygons(scene), 12U);
}

TEST(ClosedBodies, OneFaceTurnedTheOtherWayStaysTwoSided) {
    Scene scene = room_with_box();
    std::reverse(scene.polygons[7].corners.begin(), scene.polygons[7].corners.end());
    close_bodies(scene);
    EXPECT_EQ(two_sided_polygons(scene), 12U);
}

}  // namespace
}  // namespace exitance
