// SPDX-License-Identifier: Apache-2.0
// What patches reflect, in cells: what is far brighter than the rest is taken out of them to be
// lamps, and no light is lost or won by that.
#include "exitance/solve/patch_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/pipeline.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_square;
using exitance::testing::add_surface;

/// A room of 4 m × 3 m × 2.5 m whose lamp shines upward, 10 cm below the ceiling.
Scene uplight() {
    Scene scene;
    add_room(scene, {}, {4, 3, 2.5}, 0.6);
    const auto s = add_surface(scene, "lamp", 0);
    scene.materials[scene.surfaces[s].material].exitance = {100, 100, 100};
    add_square(scene, s, 1.9, 1.4, 2.4, 0.2);
    return scene;
}

double flux(const PatchCells& cells, const Radiosity& radiosity) {
    constexpr int steps = 16;  // the cells' own, at the most, twice
    const Mesh& mesh = radiosity.mesh;
    double sum = 0;
    for (std::uint32_t p = 0; p < mesh.patches().size(); ++p) {
        const Element& root = mesh[mesh.patches()[p].root];
        double mean = 0, count = 0;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const float u = (float(i) + 0.25f) / steps, v = (float(j) + 0.25f) / steps;
                if (root.count == 3 && u + v > 1) continue;
                mean += double(*cells.exitance(p, u, v)), ++count;
            }
        sum += double(root.area) * mean / count;
    }
    return sum;
}

Scene floor_of_a_trapezium_and_a_triangle() {
    Scene scene;
    const auto s = add_surface(scene, "floor", 0.5);
    add_polygon(scene, s, {{0, 0, 0}, {4, 0, 0}, {5, 3, 0}, {0, 3, 0}});
    add_polygon(scene, s, {{0, 3, 0}, {5, 3, 0}, {0, 5, 0}});
    return scene;
}

std::vector<ElementId> roots_of(const Mesh& mesh) {
    std::vector<ElementId> out;
    for (const Patch& patch : mesh.patches()) out.push_back(patch.root);
    return out;
}

class Cells : public ::testing::Test {
  protected:
    Cells()
        : scene(floor_of_a_trapezium_and_a_triangle()),
          radiosity(scene, make_groups(scene, Grouping::none), MeshOptions::of_patches(0.5)),
          roots(roots_of(radiosity.mesh)),
          slopes(radiosity.mesh, std::vector<float>(roots.size(), 1.0f)),
          cells(radiosity, roots, slopes, std::size_t{1} << 30) {}

    void give(const auto& at) {
        for (std::size_t v = 0; v < radiosity.mesh.vertices().size(); ++v)
            for (std::size_t c = 0; c < 3; ++c)
                radiosity.irradiance[VertexId(v)][c] =
                    static_cast<float>(at(Vec3(radiosity.mesh.vertices()[v].sample)));
        const RowField unknown;
        cells.divide(unknown);
        cells.fill(unknown);
    }

    Scene scene;
    Radiosity radiosity;
    std::vector<ElementId> roots;
    PatchSlopes slopes;
    PatchCells cells;
};

TEST_F(Cells, BrightOnesBecomeLampsOfTheSameLight) {
    // Two spots, one on quadrilaterals without right angles, one on triangles.
    give([](const Vec3& p) {
        return 1 + 200 * std::exp(-10 * std::pow(length(p - Vec3{4, 2, 0}), 2)) +
               100 * std::exp(-20 * std::pow(length(p - Vec3{1, 4, 0}), 2));
    });
    const double before = flux(cells, radiosity);
    const auto lamps = cells.take_brightest();
    ASSERT_GT(lamps.size(), 10u);
    double taken = 0;
    bool any_triangle = false, any_quadrilateral = false;
    for (const Lamps::Placed& placed : lamps) {
        taken += double(placed.lamp.polygon->area) * double(placed.lamp.emitted[0]);
        EXPECT_FLOAT_EQ(placed.lamp.level, radiosity.columns.luminance(placed.lamp.emitted));
        EXPECT_GT(placed.lamp.polygon->normal.z, 0.999f);
        (placed.lamp.polygon->count == 3 ? any_triangle : any_quadrilateral) = true;
    }
    EXPECT_TRUE(any_triangle && any_quadrilateral);
    EXPECT_GT(taken, 0.3 * before);
    // Cells of quadrilaterals that are no parallelograms differ in size, by a tenth.
    EXPECT_NEAR(flux(cells, radiosity) + taken, before, 0.03 * before);
    double told = 0;
    for (std::uint32_t p = 0; p < roots.size(); ++p)
        told += double(cells.taken_from(p)[0]) * double(radiosity.mesh[roots[p]].area);
    EXPECT_NEAR(told, taken, 1e-4 * taken);
}

TEST_F(Cells, EvenLightKeepsAll) {
    give([](const Vec3& p) { return 1 + 4 * std::exp(-length(p)); });
    EXPECT_TRUE(cells.take_brightest().empty());
    EXPECT_EQ(cells.taken_from(0)[0], 0.0f);
}

TEST(Uplight, IsLitByFewRays) {
    SolveOptions options;
    options.error = 0.05;
    const Solution solution = light(uplight(), options);
    ASSERT_TRUE(solution.error);
    EXPECT_LE(solution.error->rms, 0.05);
    EXPECT_LT(solution.error->confidence, 0.03);
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.02);
    // Rays in all directions alone need ten times as many, and then stop short of the error.
    EXPECT_LT(solution.counters.at("rays"), 3e7);
    for (const float H : solution.irradiance.values()) EXPECT_GE(H, 0.0f);
}

}  // namespace
}  // namespace exitance
