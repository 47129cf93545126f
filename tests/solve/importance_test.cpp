// SPDX-License-Identifier: Apache-2.0
// Solves that are refined for what a camera or a grid sees: right there, for less work.
#include "exitance/solve/importance.h"

#include <gtest/gtest.h>

#include "exitance/pipeline.h"
#include "exitance/render/camera_rays.h"
#include "exitance/run/error.h"
#include "exitance/solution/probe.h"
#include "exitance/solution/surface_probe.h"
#include "exitance/solve/element_methods.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;

constexpr double asked = 0.02;

SolveOptions gathering(double error = asked) {
    SolveOptions options;
    options.solver = adaptive_gathering;
    options.error = error;
    return options;
}

/// A room of two lamps with a camera that looks into a corner of it, sensors on a piece of its
/// floor and sensors in the air.
Scene looked_at() {
    Scene scene = two_lamp_room();
    Camera camera;
    camera.name = "corner";
    camera.eye = {1.2, 1.0, 1.0}, camera.look_at = {0, 2, 0.3}, camera.up = {0, 0, 1};
    camera.fov_y = 35, camera.aspect = 1;
    scene.cameras.push_back(camera);
    scene.grids.push_back({"floor", {0.2, 1.2, 0}, {0.7, 0, 0}, {0, 0.7, 0}, {0, 0, 1}, 12, 12});
    scene.grids.push_back({"air", {0.4, 0.4, 1}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1}, 3, 3});
    return scene;
}

/// Points on the surfaces that a camera sees.
std::vector<GatherPoint> seen(const Solution& solution, const Camera& camera) {
    constexpr std::uint32_t side = 48;
    const Surfaces surfaces(solution, Backs::black);
    const CameraRays rays(camera, side, side);
    std::vector<GatherPoint> out;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Vec3 along = rays.direction(i % side + 0.5, double(i / side) + 0.5);
        const auto hit = surfaces.caster().closest(rays.eye(), along, 0, 1e9);
        if (!hit) continue;
        const Vec3 normal = normalized(Vec3(hit->geometric_normal));
        out.push_back({rays.eye() + along * double(hit->distance),
                       dot(normal, along) < 0 ? normal : -normal});
    }
    return out;
}

/// RMS of the difference of luminances over their mean.
double difference(const std::vector<double>& a, const std::vector<double>& truth,
                  const Solution& solution) {
    const std::size_t columns = solution.columns();
    double square = 0, sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += columns) {
        const double x = solution.luminance({&a[i], columns});
        const double y = solution.luminance({&truth[i], columns});
        if (std::isnan(x) || std::isnan(y)) continue;
        square += (x - y) * (x - y), sum += y, ++count;
    }
    return std::sqrt(square / double(count)) / (sum / double(count));
}

class Importance : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        truth = std::make_unique<Solution>(light(looked_at(), gathering(0.004)));
        all = std::make_unique<Solution>(light(looked_at(), gathering()));
    }
    static void TearDownTestSuite() { truth.reset(), all.reset(); }

    static void expect_less_work(const Solution& some, double share) {
        EXPECT_LT(some.counters.at("rays"), share * all->counters.at("rays"));
        EXPECT_LT(double(some.positions.size()), share * double(all->positions.size()));
    }

    static inline std::unique_ptr<Solution> truth, all;
};

TEST_F(Importance, WhatACameraSeesIsRightForLessWork) {
    SolveOptions options = gathering();
    options.view = "corner";
    const Solution some = light(looked_at(), options);
    const auto points = seen(*truth, truth->cameras.front());
    ASSERT_GT(points.size(), 2000u);
    const double found = difference(probe(some, points), probe(*truth, points), some);
    EXPECT_LT(found, asked);
    expect_less_work(some, 0.6);
    ASSERT_TRUE(some.error);
    EXPECT_LT(some.error->rms, asked);
    ASSERT_TRUE(some.refined_for);
    EXPECT_EQ(some.refined_for->camera, "corner");
    EXPECT_FALSE(some.refined_for->grid);
    EXPECT_FALSE(all->refined_for);
}

TEST_F(Importance, SensorsOnASurfaceReadRight) {
    SolveOptions options = gathering();
    options.grid = "floor";
    const Solution some = light(looked_at(), options);
    const auto points = sensor_points(some.grids[0]);
    EXPECT_LT(difference(probe(some, points), probe(*truth, points), some), asked);
    expect_less_work(some, 0.6);
    EXPECT_EQ(some.refined_for->grid, "floor");
}

TEST_F(Importance, SensorsInTheAirReadRight) {
    SolveOptions options = gathering();
    options.grid = "air";
    const Solution some = light(looked_at(), options);
    const auto points = sensor_points(some.grids[1]);
    ProbeOptions gathered;
    gathered.method = "gather";
    const double found =
        difference(probe(some, points, gathered), probe(*truth, points, gathered), some);
    EXPECT_LT(found, asked);
    expect_less_work(some, 0.8);
}

TEST_F(Importance, CameraAndGridTogetherAreBothServed) {
    SolveOptions options = gathering();
    options.view = "corner", options.grid = "floor";
    const Solution both = light(looked_at(), options);
    const auto points = sensor_points(both.grids[0]);
    EXPECT_LT(difference(probe(both, points), probe(*truth, points), both), asked);
    const auto visible = seen(*truth, truth->cameras.front());
    EXPECT_LT(difference(probe(both, visible), probe(*truth, visible), both), asked);
}

std::size_t vertices_beyond(const Solution& solution, double x) {
    return std::size_t(
        std::ranges::count_if(solution.positions, [&](const Vec3f& p) { return double(p.x) > x; }));
}

TEST(ImportanceOfRooms, WhatNobodySeesStaysAsItWas) {
    Scene scene = looked_at();
    add_room(scene, {10, 0, 0}, {13, 2, 2}, 0.6);
    add_lamp(scene, "hidden", {11, 1, 1.95}, 0.4, {20, 20, 20});
    add_block(scene, {11.2, 0.8, 0}, {11.8, 1.3, 0.7}, 0.4);
    SolveOptions options = gathering();
    options.view = "corner", options.merge = false;
    const std::size_t focused = vertices_beyond(light(scene, options), 5);
    options.adaptive = false;
    EXPECT_EQ(focused, vertices_beyond(light(scene, options), 5)) << "patches, undivided";
    options.view.reset(), options.adaptive = true;
    EXPECT_GT(vertices_beyond(light(scene, options), 5), 2 * focused);
}

TEST(ImportanceOfRooms, ACameraSeesThroughGlass) {
    // The camera stands behind a pane across the room.
    const auto with_pane = [](double transmittance) {
        Scene scene = looked_at();
        scene.cameras[0].eye = {2.8, 1.9, 1.5}, scene.cameras[0].look_at = {0, 0.6, 0.2};
        const auto s = testing::add_surface(scene, "pane", 0.05);
        Material& glass = scene.materials[scene.surfaces[s].material];
        glass.two_sided = true;
        glass.transmittance.assign(3, transmittance);
        testing::add_polygon(scene, s, {{2.2, 0, 0}, {2.2, 2, 0}, {2.2, 2, 2}, {2.2, 0, 2}});
        return scene;
    };
    SolveOptions options = gathering(0.05);
    options.view = "corner";
    const auto near_corner = [](const Solution& solution) {
        return std::ranges::count_if(solution.positions, [](const Vec3f& p) { return p.x < 1; });
    };
    const auto through = near_corner(light(with_pane(0.8), options));
    const auto hidden = near_corner(light(with_pane(0), options));
    EXPECT_GT(through, 2 * hidden);
}

void expect_refused(const Scene& scene, const SolveOptions& options, const std::string& said) {
    try {
        light(scene, options);
        ADD_FAILURE() << "no error that says " << said;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
}

TEST(ImportanceOfRooms, WrongNamesAndUses) {
    SolveOptions options = gathering();
    options.view = "corned";
    expect_refused(looked_at(), options, "did you mean 'corner'");
    expect_refused(two_lamp_room(), options, "the scene has none");
    options.view.reset(), options.grid = "flor";
    expect_refused(looked_at(), options, "there are: floor, air");
    options.grid = "floor", options.solver = adaptive_shooting;
    expect_refused(looked_at(), options, "expected --solver gathering");
    options = gathering();
    options.view = "corner";
    Scene away = looked_at();
    away.cameras[0].eye = {50, 0, 0}, away.cameras[0].look_at = {60, 0, 0};
    expect_refused(away, options, "no surface is seen");
}

}  // namespace
}  // namespace exitance
