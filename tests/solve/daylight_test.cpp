// SPDX-License-Identifier: Apache-2.0
// Whole solves of scenes that sun and sky light, and light through glass.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic/configuration_factors.h"
#include "exitance/solution/gather.h"
#include "exitance/solution/surface_probe.h"
#include "exitance/solution/surfaces.h"
#include "scene/lamps.h"
#include "solve/solve_scenes.h"
#include "truth/path_tracer.h"

namespace exitance {
namespace {

using solve_scenes::add_room;
constexpr double pi = std::numbers::pi;

DistantLight sky_of(SkyModel model, double scale) {
    DistantLight light;
    light.kind = DistantLight::Kind::sky;
    light.name = light.group = "sky";
    light.model = model;
    light.model.scale = scale;
    return light;
}

DistantLight sun_from(const Vec3& direction, double irradiance, double degrees) {
    DistantLight light;
    light.name = light.group = "sun";
    light.direction = normalized(direction);
    light.diameter = degrees * pi / 180;
    light.irradiance = irradiance;
    return light;
}

// A plane facing up (+y) of edge `size` around the origin at the height y.
void add_floor(Scene& scene, double rho, double size = 4, double y = 0) {
    const double h = size / 2;
    testing::add_polygon(scene, testing::add_surface(scene, "floor", rho),
                         {{-h, y, -h}, {-h, y, h}, {h, y, h}, {h, y, -h}});
}

double gathered(const Solution& solution, const Vec3& p, const Vec3& n) {
    const Surfaces surfaces(solution, Backs::black);
    std::vector<double> found(solution.columns());
    const std::vector<GatherPoint> points{{p, n}};
    gather(surfaces, points, found);
    double sum = 0;
    for (std::size_t g = 0; g < solution.groups.size(); ++g) sum += found[3 * g + 1];
    return sum;
}

TEST(Daylight, OpenSkiesGiveTheirClosedForms) {
    // Horizontal: π L, 7π/9 Lz. A vertical wall: half of π L, and (π/6 + 4/9) Lz under the overcast
    // sky, ∫ L cosθ dω over the quarter sphere that it sees. 0.2 % for the cells at its horizon.
    struct Open {
        SkyModel model;
        double horizontal, vertical;
    };
    for (const Open& open :
         {Open{cie_sky(5), pi, pi / 2}, {cie_sky(16), 7 * pi / 9, pi / 6 + 4 / 9.0}}) {
        Scene scene;
        add_floor(scene, 0);
        scene.distant.push_back(sky_of(open.model, 1000));
        const Solution solution = light(scene, {});
        const Surfaces surfaces(solution, Backs::black);
        std::vector<double> found(3);
        ASSERT_TRUE(probe_surface(surfaces, {0.3, 0, 0.2}, {0, 1, 0}, found));
        EXPECT_NEAR(found[1], 1000 * open.horizontal, 2e-3 * found[1]);
        EXPECT_NEAR(gathered(solution, {0, 3, 0}, {0, 1, 0}), 1000 * open.horizontal,
                    2.0 * open.horizontal);
        EXPECT_NEAR(gathered(solution, {9, 1, 0}, {0, 0, 1}), 1000 * open.vertical,
                    3.0 * open.vertical);
        EXPECT_NEAR(solution.energy.emitted, 16000 * open.horizontal,
                    0.01 * solution.energy.emitted);
        EXPECT_LT(std::abs(solution.energy.imbalance()), 5e-3);
    }
}

// A black box 4 × 3 × 4 whose wall at z = 0 has an opening x ∈ [1, 3], y ∈ [1, 2.2].
Scene box_with_window(bool glazed) {
    Scene scene;
    const auto wall = testing::add_surface(scene, "wall", 0);
    scene.materials[scene.surfaces[wall].material].two_sided = true;
    const auto add = [&](std::initializer_list<Vec3> c) { testing::add_polygon(scene, wall, c); };
    add({{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}});
    add({{0, 3, 0}, {4, 3, 0}, {4, 3, 4}, {0, 3, 4}});
    add({{0, 0, 0}, {0, 3, 0}, {0, 3, 4}, {0, 0, 4}});
    add({{4, 0, 0}, {4, 0, 4}, {4, 3, 4}, {4, 3, 0}});
    add({{0, 0, 4}, {0, 3, 4}, {4, 3, 4}, {4, 0, 4}});
    add({{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}});
    add({{0, 2.2, 0}, {4, 2.2, 0}, {4, 3, 0}, {0, 3, 0}});
    add({{0, 1, 0}, {1, 1, 0}, {1, 2.2, 0}, {0, 2.2, 0}});
    add({{3, 1, 0}, {4, 1, 0}, {4, 2.2, 0}, {3, 2.2, 0}});
    if (glazed) {
        const auto pane = testing::add_surface(scene, "pane", 0);
        Material& glass = scene.materials[scene.surfaces[pane].material];
        glass.transmittance = Spectrum(3, 0.8);
        glass.two_sided = true;
        testing::add_polygon(scene, pane, {{1, 1, 0}, {3, 1, 0}, {3, 2.2, 0}, {1, 2.2, 0}});
    }
    scene.distant.push_back(sky_of(cie_sky(5), 1000));
    return scene;
}

TEST(Daylight, AWindowIsAPolygonOfTheSky) {
    // A uniform sky through a window: π L times the exact factor of its polygon above the horizon;
    // behind the point nothing lies below the window's sill. On the floor: Howell B-4 twice, less
    // the part below the sill.
    for (const bool glazed : {false, true}) {
        SolveOptions options;
        options.error = 0.005;
        options.patch_size = 0.1;  // nothing is refined where nothing is reflected
        const Solution solution = light(box_with_window(glazed), options);
        for (const double z : {0.8, 1.5, 3.2}) {
            const double x = 1.7;
            double factor = 0;
            for (const double b : {3 - x, x - 1})
                factor += analytic::perpendicular_rectangle(2.2, b, z) -
                          analytic::perpendicular_rectangle(1.0, b, z);
            const double exact = 1000 * pi * factor * (glazed ? 0.8 : 1);
            EXPECT_NEAR(gathered(solution, {x, 0, z}, {0, 1, 0}), exact, 0.01 * exact)
                << (glazed ? "glazed, " : "open, ") << z << " m from the window: 1 % of rays";
            const Surfaces surfaces(solution, Backs::black);
            std::vector<double> found(3);
            ASSERT_TRUE(probe_surface(surfaces, {x, 0, z}, {0, 1, 0}, found));
            EXPECT_NEAR(found[1], exact, 0.03 * exact + 4)
                << z << " m: 0.5 % of the mean of all faces, 800 lx for the outer ones, on top";
        }
    }
}

TEST(Daylight, TheSunCastsShadowsOfItsSize) {
    // A roof 2 m above the floor and the sun 45° high: its edge's shadow lies 2 m aside, and the
    // penumbra is 2 √2 · tan(0.53°) · √2 m wide, which is 3.7 cm; far from it all or nothing.
    Scene scene;
    add_floor(scene, 0.3, 8);
    const auto roof = testing::add_surface(scene, "roof", 0);
    scene.materials[scene.surfaces[roof].material].two_sided = true;
    testing::add_polygon(scene, roof, {{-0.93, 2, -1}, {-0.93, 2, 1}, {1.07, 2, 1}, {1.07, 2, -1}});
    scene.distant.push_back(sun_from({1, 1, 0}, 50000, 0.53));
    const Solution solution = light(scene, {});
    const double open = 50000 * std::sqrt(0.5);
    const Surfaces surfaces(solution, Backs::black);
    const auto at = [&](double x, double z) {
        std::vector<double> found(3);
        EXPECT_TRUE(probe_surface(surfaces, {x, 0, z}, {0, 1, 0}, found));
        return found[1];
    };
    EXPECT_NEAR(at(-2, 0), 0, 0.01 * open) << "the middle of the shadow";
    EXPECT_NEAR(at(-0.7, 0.3), open, 0.02 * open);
    EXPECT_NEAR(at(2.5, 0), open, 0.01 * open);
    EXPECT_NEAR(gathered(solution, {-0.93, 0, 0}, {0, 1, 0}), 0.5 * open, 0.05 * open)
        << "half of the sun stands above the edge";
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.01);
    EXPECT_GT(solution.positions.size(), 2000U) << "the mesh follows the shadow";
}

TEST(Daylight, APaneBetweenLampAndFloorTakesItsShare) {
    for (const bool pane : {false, true}) {
        Scene scene;
        testing::add_square(scene, testing::add_surface(scene, "floor", 0), -2, -2, 0, 4);
        const auto glass = testing::add_surface(scene, "glass", 0);
        scene.materials[scene.surfaces[glass].material].transmittance = Spectrum(3, 0.8);
        scene.materials[scene.surfaces[glass].material].two_sided = true;
        if (pane) testing::add_square(scene, glass, -3, -3, 1, 6);
        solve_scenes::add_lamp(scene, "lamp", {0, 0, 2}, 0.5, Spectrum(3, 100.0));
        scene.luminaires.push_back(
            testing::hanging(testing::cosine_photometry(100), {0.5, 0.5, 3}));
        const Solution solution = light(scene, {});
        const double r2 = 0.5 + 9;
        const double lamp = 100 * analytic::parallel_rectangle(-0.25, 0.25, -0.25, 0.25, 2);
        const double exact = (pane ? 0.8 : 1) * (100 * 9 / (r2 * r2) + lamp);
        EXPECT_NEAR(gathered(solution, {0, 0, 0}, {0, 0, 1}), exact, 2e-3 * exact);
        EXPECT_LT(std::abs(solution.energy.imbalance()), 0.01) << "what glass takes is counted";
    }
}

TEST(Daylight, VerticesGatherAndPathTracerAgree) {
    Scene scene = box_with_window(true);
    for (Material& material : scene.materials)
        if (material.name == "wall") material.reflectance = Spectrum(3, 0.5);
    scene.distant[0].ground = 200;
    scene.distant.push_back(sun_from({0.2, 0.6, -1}, 20000, 0.53));
    const Solution solution = light(scene, {});
    ASSERT_EQ(solution.groups.size(), 2U);
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.02);
    const Surfaces surfaces(solution, Backs::black);
    const std::vector<GatherPoint> points{{{0.5, 0, 2.5}, {0, 1, 0}},
                                          {{2, 3, 2}, {0, -1, 0}},
                                          {{2, 1.5, 4}, {0, 0, -1}},
                                          {{0, 1, 1}, {1, 0, 0}},
                                          {{1.8, 0, 1.4}, {0, 1, 0}}};
    std::vector<truth::Receiver> receivers;
    for (const GatherPoint& p : points) receivers.push_back({p.position, p.normal});
    const truth::Estimate exact =
        truth::PathTracer(scene, Grouping::file).irradiance(receivers, {1024, 16, 3});
    std::vector<double> found(points.size() * 6);
    gather(surfaces, points, found);
    for (std::size_t p = 0; p < points.size(); ++p)
        for (const std::size_t c : {std::size_t{1}, std::size_t{4}})
            EXPECT_NEAR(found[6 * p + c], exact.at(p, c),
                        0.03 * exact.at(p, c) + 5 * exact.error_at(p, c))
                << "point " << p << ", column " << c << ": 3 % for what the solution was asked for";
}

TEST(Daylight, TheNumberOfThreadsDoesNotMatter) {
    SolveOptions options;
    options.error = 0.1;
    options.threads = 1;
    const Solution one = light(box_with_window(true), options);
    options.threads = 2;
    const Solution two = light(box_with_window(true), options);
    EXPECT_TRUE(std::ranges::equal(one.irradiance.values(), two.irradiance.values()));
    EXPECT_EQ(one.energy.emitted, two.energy.emitted);
}

}  // namespace
}  // namespace exitance
