// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/run/random.h"
#include "solution/hand_made.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

/// Factor from a horizontal point to a parallel rectangle a × b at height c whose corner is right
/// above the point (Hamilton & Morgan 1952).
double corner_factor(double a, double b, double c) {
    const double X = a / c, Y = b / c;
    return (X / std::hypot(1, X) * std::atan(Y / std::hypot(1, X)) +
            Y / std::hypot(1, Y) * std::atan(X / std::hypot(1, Y))) /
           (2 * pi);
}

/// A lamp of 1 × 1 m at y = 2 over the origin, facing down, with exitance 100, 50, 25 in group 1.
Solution lamp_scene() {
    Solution s = hand_made::empty_solution({{"other", 1.0}, {"lamp", 1.0}});
    const auto lamp = hand_made::add_material(s, "lamp", {0, 0, 0}, {100, 50, 25});
    hand_made::add_sheet(s, "lamp", lamp, 1, {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, 2, 2,
                         hand_made::uniform(s, 0));
    return s;
}

std::vector<double> gather_at(const Solution& s, const Vec3& p, const Vec3& n,
                              const GatherOptions& options = {}) {
    const Surfaces surfaces(s, Backs::black);
    const GatherPoint point{p, n};
    std::vector<double> E(s.columns());
    gather(surfaces, {&point, 1}, E, options);
    return E;
}

TEST(Gather, point_under_a_square_lamp) {
    const auto E = gather_at(lamp_scene(), {0, 0, 0}, {0, 1, 0});
    const double F = 4 * corner_factor(0.5, 0.5, 2);
    EXPECT_NEAR(E[3], 100 * F, 1e-9);
    EXPECT_NEAR(E[4], 50 * F, 1e-9);
    EXPECT_NEAR(E[5], 25 * F, 1e-9);
    EXPECT_EQ(E[0], 0);
    EXPECT_EQ(gather_at(lamp_scene(), {0, 0, 0}, {0, -1, 0})[3], 0);
    EXPECT_EQ(gather_at(lamp_scene(), {0, 3, 0}, {0, -1, 0})[3], 0) << "behind the lamp";
}

TEST(Gather, half_hidden_lamp) {
    Solution s = lamp_scene();
    const auto black = hand_made::add_material(s, "screen", {0, 0, 0});
    // A screen right under the half x < 0 of the lamp, seen from its black back.
    hand_made::add_sheet(s, "screen", black, 0, {-3, 1.999, -3}, {0, 0, 6}, {3, 0, 0}, 1, 1,
                         hand_made::uniform(s, 0));
    const double F = 2 * corner_factor(0.5, 0.5, 2);
    // 1024 low-discrepancy samples of a straight edge: error below 1 %.
    EXPECT_NEAR(gather_at(s, {0, 0, 0}, {0, 1, 0})[3], 100 * F, 0.01 * 100 * F);
}

TEST(Gather, lamp_cut_by_the_horizon_and_a_screen) {
    // The receiver's plane x = 0 cuts the lamp in half; nothing else hides it.
    const auto open = gather_at(lamp_scene(), {0, 1.5, 0}, {1, 0, 0});
    Solution s = lamp_scene();
    const auto black = hand_made::add_material(s, "screen", {0, 0, 0});
    // The screen hides z < 0; by symmetry exactly half of the light remains.
    hand_made::add_sheet(s, "screen", black, 0, {-3, 1.99, -3}, {6, 0, 0}, {0, 0, 3}, 1, 1,
                         hand_made::uniform(s, 0));
    const auto half = gather_at(s, {0, 1.5, 0}, {1, 0, 0});
    EXPECT_GT(open[3], 1);
    EXPECT_NEAR(half[3], open[3] / 2, 0.015 * open[3]);
}

TEST(Gather, uniform_closed_box_gives_its_exitance_everywhere) {
    // B = 7 on every wall: the irradiance of any point inside, on any side, is 7.
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.7, 0.875});
    hand_made::add_room(s, grey, {0, 0, 0}, {4, 3, 5}, 2, [](const Vec3&, const Vec3&) {
        return std::vector<float>{14, 10, 8};
    });
    for (std::uint32_t i = 0; i < 20; ++i) {
        const auto [u, v] = low_discrepancy(3, i);
        const auto E = gather_at(s, {4 * u, 0, 5 * v}, {0, 1, 0});
        for (const double e : E) EXPECT_NEAR(e, 7, 0.001 * 7);
        const auto inside = gather_at(s, {4 * u, 1, 5 * v}, normalized(Vec3{u, -1, v}));
        for (const double e : inside) EXPECT_NEAR(e, 7, 0.001 * 7);
    }
    // Edges and corners too: the walls that meet there are in front of the point.
    for (const Vec3& p : {Vec3{0, 0, 0}, {4, 0, 0}, {4, 0, 5}, {1.7, 0, 5}, {4, 0, 2.2}})
        EXPECT_NEAR(gather_at(s, p, {0, 1, 0})[0], 7, 0.001 * 7);
}

TEST(Gather, reflected_light_of_a_wall) {
    // A wall of exitance 10 faces the point as a parallel rectangle; the rest of space is empty.
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_sheet(s, "wall", grey, 0, {-1, 1, -1.5}, {2, 0, 0}, {0, 0, 3}, 4, 4,
                         hand_made::uniform(s, 20));
    const double exact = 10 * 4 * corner_factor(1, 1.5, 1);
    // The outline cuts the hemisphere: 1024 stratified rays, about N^(-3/4) = 0.6 %.
    EXPECT_NEAR(gather_at(s, {0, 0, 0}, {0, 1, 0})[0], exact, 0.015 * exact);
    EXPECT_NEAR(gather_at(s, {0, 0, 0}, {0, 1, 0}, {.hemisphere_rays = 65536})[0], exact,
                0.001 * exact);
}

TEST(Gather, backs_are_black_unless_two_sided) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    const auto add = [&](double H, const Vec3& u, const Vec3& v) {
        hand_made::add_sheet(s, "board", grey, 0, {-50, 1, -50}, u, v, 1, 1,
                             hand_made::uniform(s, H));
    };
    add(20, {0, 0, 100}, {100, 0, 0});  // faces up, away from the point
    EXPECT_EQ(gather_at(s, {0, 0, 0}, {0, 1, 0})[0], 0);
    s.materials[grey].two_sided = true;
    add(12, {100, 0, 0}, {0, 0, 100});  // its other side
    // Factor of the board: 1 − 2e-4 / …, all but the horizon; B = 6.
    EXPECT_NEAR(gather_at(s, {0, 0, 0}, {0, 1, 0})[0], 6, 0.02);
    EXPECT_NEAR(gather_at(s, {0, 2, 0}, {0, -1, 0})[0], 10, 0.03);
}

TEST(Gather, many_points_do_not_depend_on_their_order_of_work) {
    Solution s = lamp_scene();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_room(s, grey, {-2, 0, -2}, {2, 2.5, 2}, 3, hand_made::uniform(s, 5));
    std::vector<GatherPoint> points;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto [u, v] = low_discrepancy(5, i);
        points.push_back({{4 * u - 2, 0.8, 4 * v - 2}, {0, 1, 0}});
    }
    const Surfaces surfaces(s, Backs::black);
    std::vector<double> first(points.size() * s.columns()), second(first);
    gather(surfaces, points, first, {.hemisphere_rays = 64});
    gather(surfaces, points, second, {.hemisphere_rays = 64});
    EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace exitance
