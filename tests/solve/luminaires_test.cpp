// SPDX-License-Identifier: Apache-2.0
// Whole solves of rooms that luminaires light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/solution/gather.h"
#include "exitance/solution/surfaces.h"
#include "scene/lamps.h"
#include "solve/solve_scenes.h"
#include "truth/path_tracer.h"

namespace exitance {
namespace {

using solve_scenes::add_block;
using solve_scenes::add_room;
using testing::crooked_photometry;
using testing::hanging;

// A tube and a spot of other colours, over a block.
Scene furnished_room() {
    Scene scene;
    scene.quantity = Quantity::photometric;
    add_room(scene, {}, {3, 2, 2}, 0.5);
    add_block(scene, {1.2, 0.8, 0}, {1.8, 1.3, 0.7}, 0.4);
    const auto tube = testing::opening(LuminousOpening::Shape::box, {0.1, 1.2, 0});
    scene.luminaires.push_back(hanging(crooked_photometry(tube), {0.9, 1, 1.9}));
    scene.luminaires.back().name = "tube";
    scene.luminaires.back().colour = {1.2, 1, 0.4112188};
    scene.luminaires.push_back(hanging(testing::cosine_photometry(300), {2.4, 0.7, 1.7}));
    scene.luminaires.back().name = "downlight";
    return scene;
}

TEST(Luminaires, ABlackBoxReceivesTheFluxThatIsEmitted) {
    // 0.2 %, asked for of every source; the mesh is even and fine, since nothing is refined where
    // nothing is reflected.
    for (const LuminousOpening& opening : testing::all_openings()) {
        Scene scene;
        add_room(scene, {}, {3, 2.5, 2}, 0);
        scene.luminaires.push_back(hanging(crooked_photometry(opening), {1.4, 1.3, 1.1}));
        SolveOptions options;
        options.patch_size = 0.06;
        const EnergyBalance energy = light(scene, options).energy;
        EXPECT_NEAR(energy.emitted, scene.luminaires[0].flux(), 1e-6 * energy.emitted);
        EXPECT_NEAR(energy.absorbed, energy.emitted, 2e-3 * energy.emitted)
            << "shape " << int(opening.shape) << ", height " << opening.size.z;
        EXPECT_EQ(energy.escaped + energy.absorbed_behind, 0);
    }
}

TEST(Luminaires, WhatLeavesTheSceneIsMeasured) {
    // A floor alone: its light is integrated over the mesh, the rest is followed by rays.
    Scene scene;
    testing::add_square(scene, testing::add_surface(scene, "floor", 0.3), -2, -2, 0, 4);
    scene.luminaires.push_back(hanging(crooked_photometry(), {0.2, -0.1, 1.5}));
    const EnergyBalance energy = light(scene, {}).energy;
    EXPECT_GT(energy.escaped, 0.3 * energy.emitted);
    EXPECT_GT(energy.absorbed, 0.1 * energy.emitted);
    EXPECT_LT(std::abs(energy.imbalance()), 2e-3);
}

TEST(Luminaires, ARoomKeepsItsLight) {
    const Solution solution = light(furnished_room(), {});
    EXPECT_LT(std::abs(solution.energy.imbalance()), 5e-3);
    ASSERT_TRUE(solution.error.has_value());
    EXPECT_LT(solution.error->rms, 0.02) << "what was asked for";
    EXPECT_GT(solution.error->rms, 0);
}

TEST(Luminaires, EachIsALightGroup) {
    const Scene scene = furnished_room();
    SolveOptions options;
    options.groups = "luminaire";
    const Solution all = light(scene, options);
    ASSERT_EQ(all.groups.size(), 2U);
    EXPECT_EQ(all.groups[0].name, "tube");
    EXPECT_EQ(all.groups[1].name, "downlight");
    Scene only = scene;
    only.luminaires.erase(only.luminaires.begin());
    const Solution one = light(only, options);
    const Surfaces in_all(all, Backs::black), in_one(one, Backs::black);
    const std::vector<GatherPoint> points{{{0.4, 0.4, 0}, {0, 0, 1}}, {{2.2, 1.6, 0}, {0, 0, 1}}};
    std::vector<double> a(12), b(6);
    gather(in_all, points, a);
    gather(in_one, points, b);
    for (std::size_t p = 0; p < 2; ++p)
        EXPECT_NEAR(a[6 * p + 4], b[3 * p + 1], 0.02 * b[3 * p + 1]);
    // Colour of the first: R to B as its lamp's 1.2 to 0.41, for the room is grey.
    EXPECT_NEAR(a[0] / a[2], 1.2 / 0.4112188, 1e-3 * a[0] / a[2]);
}

TEST(Luminaires, VerticesGatherAndPathTracerAgree) {
    const Scene scene = furnished_room();
    SolveOptions options;
    options.error = 0.01;
    const Solution solution = light(scene, options);
    std::vector<GatherPoint> points;
    std::vector<truth::Receiver> receivers;
    // On the floor, in shadow and penumbra too, on the block and on walls.
    for (const auto& [p, n] : std::vector<std::pair<Vec3, Vec3>>{{{0.3, 0.3, 0}, {0, 0, 1}},
                                                                 {{1.95, 1.05, 0}, {0, 0, 1}},
                                                                 {{2.05, 1.6, 0}, {0, 0, 1}},
                                                                 {{1.05, 1.1, 0}, {0, 0, 1}},
                                                                 {{1.5, 1, 0.7}, {0, 0, 1}},
                                                                 {{0, 1, 1}, {1, 0, 0}},
                                                                 {{1.5, 2, 1.2}, {0, -1, 0}},
                                                                 {{1.8, 1, 0.35}, {1, 0, 0}},
                                                                 {{0.9, 1.2, 1}, {0, 0, 1}}}) {
        points.push_back({p, n});
        receivers.push_back({p, n});
    }
    const truth::Estimate exact = truth::PathTracer(scene).irradiance(receivers, {1024, 16, 3});
    const Surfaces surfaces(solution, Backs::black);
    std::vector<double> found(points.size() * 3);
    gather(surfaces, points, found);
    for (std::size_t p = 0; p < points.size(); ++p)
        for (std::size_t b = 0; b < 3; ++b)
            // 1 % of the gather's and the solution's own, and the truth's noise.
            EXPECT_NEAR(found[3 * p + b], exact.at(p, b),
                        0.01 * exact.at(p, b) + 5 * exact.error_at(p, b))
                << "point " << p;
}

TEST(Luminaires, TheNumberOfThreadsDoesNotMatter) {
    SolveOptions options;
    options.error = 0.05;
    options.threads = 1;
    const Solution one = light(furnished_room(), options);
    options.threads = 2;
    const Solution two = light(furnished_room(), options);
    EXPECT_TRUE(std::ranges::equal(one.irradiance.values(), two.irradiance.values()));
    EXPECT_EQ(one.energy.escaped, two.energy.escaped);
    EXPECT_EQ(one.error->rms, two.error->rms);
}

TEST(Luminaires, TheMeshFollowsTheirShadows) {
    SolveOptions options;
    const Solution adaptive = light(furnished_room(), options);
    options.adaptive = false;
    const Solution even = light(furnished_room(), options);
    EXPECT_GT(adaptive.positions.size(), 3 * even.positions.size());
}

TEST(Luminaires, BuriedInASolidTheyLightNothing) {
    Scene scene;
    add_room(scene, {}, {3, 2, 2}, 0.5);
    add_block(scene, {1, 1, 0}, {2, 1.5, 1}, 0.5);
    scene.luminaires.push_back(hanging(testing::cosine_photometry(100), {1.5, 1.2, 0.5}));
    const Solution solution = light(scene, {});
    EXPECT_TRUE(solve_scenes::all_finite(solution));
    EXPECT_GT(solution.energy.absorbed_behind, 0.1 * solution.energy.emitted);
    const Surfaces surfaces(solution, Backs::black);
    const std::vector<GatherPoint> outside{{{0.4, 0.4, 0}, {0, 0, 1}}, {{1.5, 1.2, 1}, {0, 0, 1}}};
    std::vector<double> found(6);
    gather(surfaces, outside, found);
    for (const double E : found) EXPECT_NEAR(E, 0, 1e-6);
}

}  // namespace
}  // namespace exitance
