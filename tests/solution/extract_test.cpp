// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/extract.h"

#include <gtest/gtest.h>

#include "exitance/pipeline.h"

namespace exitance {
namespace {

TEST(Extract, OneSurfaceMayHaveManyVertices) {
    Scene scene;
    const auto add = [&](Material material, std::array<Vec3, 4> corners, std::uint32_t patches) {
        Polygon polygon;
        polygon.surface = scene.add_surface("", scene.add_material(std::move(material)));
        polygon.patches = patches;
        for (std::size_t i = 0; i < 4; ++i) polygon.corners[i] = scene.add_point(corners[i]);
        scene.polygons.push_back(polygon);
    };
    Material lamp, floor;
    lamp.reflectance = floor.reflectance = floor.exitance = {0, 0, 0};
    lamp.exitance = {1, 1, 1};
    constexpr std::uint32_t side = 128;
    add(floor, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, side * side);
    add(lamp, {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}}, 1);

    SolveOptions options;
    options.error = 0.5;
    options.adaptive = false;
    options.merge = false;
    const Solution solution = light(scene, options);
    EXPECT_EQ(solution.triangles.size(), 2 * side * side + 2);
    EXPECT_EQ(solution.positions.size(), (side + 1) * (side + 1) + 4);
}

}  // namespace
}  // namespace exitance
