// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/surface_probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/run/random.h"
#include "solution/hand_made.h"

namespace exitance {
namespace {

/// A room of 4 × 3 × 5 m whose walls carry irradiance that is linear in space, so that
/// interpolation is exact; each wall adds a constant of its own, told by its normal.
float exact(const Vec3& p, const Vec3& n) {
    return static_cast<float>(10 + 2 * p.x + 3 * p.y - p.z + 100 * n.x + 200 * n.y + 400 * n.z);
}

Solution linear_room(std::uint32_t cells = 3) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_room(s, grey, {0, 0, 0}, {4, 3, 5}, cells, [](const Vec3& p, const Vec3& n) {
        const float value = exact(p, n);
        return std::vector<float>{value, 2 * value, 3 * value};
    });
    return s;
}

// Values reach 700; positions, irradiance and weights carry 2⁻²⁴ each.
constexpr double rounding = 700 * 1e-6;

TEST(SurfaceProbe, linear_light_is_read_exactly) {
    const Solution s = linear_room();
    const Surfaces surfaces(s, Backs::black);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const auto [u, v] = low_discrepancy(7, i);
        const Vec3 floor{4 * u, 0, 5 * v}, back{4 * u, 3 * v, 0}, right{4, 3 * u, 5 * v};
        std::vector<double> E(3);
        ASSERT_TRUE(probe_surface(surfaces, floor, {0, 1, 0}, E));
        EXPECT_NEAR(E[0], double(exact(floor, {0, 1, 0})), rounding);
        EXPECT_NEAR(E[2], 3 * double(exact(floor, {0, 1, 0})), 3 * rounding);
        ASSERT_TRUE(probe_surface(surfaces, back, {0, 0, 1}, E));
        EXPECT_NEAR(E[0], double(exact(back, {0, 0, 1})), rounding);
        ASSERT_TRUE(probe_surface(surfaces, right, {-1, 0, 0}, E));
        EXPECT_NEAR(E[1], 2 * double(exact(right, {-1, 0, 0})), 2 * rounding);
    }
}

TEST(SurfaceProbe, edges_and_corners_belong_to_the_wall_that_is_meant) {
    const Solution s = linear_room();
    const Surfaces surfaces(s, Backs::black);
    const Vec3 inward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<double> E(3);
    for (const double x : {0.0, 4.0})
        for (const double y : {0.0, 3.0})
            for (const double z : {0.0, 2.5, 5.0})
                for (const Vec3& n : inward) {
                    const Vec3 p{x, y, z};
                    // The wall that faces n passes through p if p lies on its far side.
                    const bool there = (n.x > 0 && x == 0) || (n.x < 0 && x == 4) ||
                                       (n.y > 0 && y == 0) || (n.y < 0 && y == 3) ||
                                       (n.z > 0 && z == 0) || (n.z < 0 && z == 5);
                    ASSERT_EQ(probe_surface(surfaces, p, n, E), there);
                    if (!there) continue;
                    EXPECT_NEAR(E[0], double(exact(p, n)), rounding);
                }
}

TEST(SurfaceProbe, nothing_near_or_facing_away_is_no_answer) {
    const Solution s = linear_room();
    const Surfaces surfaces(s, Backs::black);
    std::vector<double> E{-1, -1, -1};
    EXPECT_FALSE(probe_surface(surfaces, {2, 1.5, 2.5}, {0, 1, 0}, E));
    EXPECT_FALSE(probe_surface(surfaces, {2, 0, 2.5}, {0, -1, 0}, E));
    EXPECT_FALSE(probe_surface(surfaces, {2, 0, 2.5}, {1, 0, 0}, E));
    EXPECT_EQ(E, (std::vector<double>{-1, -1, -1}));
    // The diagonal is √50; 3e-3 of it is 21.2 mm.
    EXPECT_TRUE(probe_surface(surfaces, {2, 0.021, 2.5}, {0, 1, 0}, E));
    EXPECT_FALSE(probe_surface(surfaces, {2, 0.0214, 2.5}, {0, 1, 0}, E));
    EXPECT_TRUE(probe_surface(surfaces, {2, 0.1, 2.5}, {0, 1, 0}, E, {.tolerance = 0.02}));
}

TEST(SurfaceProbe, the_nearer_of_two_boards_is_read) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_sheet(s, "lower", grey, 0, {}, {0, 0, 1}, {1, 0, 0}, 4, 4,
                         hand_made::uniform(s, 1));
    hand_made::add_sheet(s, "upper", grey, 0, {0, 0.0005, 0}, {0, 0, 1}, {1, 0, 0}, 3, 3,
                         hand_made::uniform(s, 2));
    const Surfaces surfaces(s, Backs::black);
    std::vector<double> E(3);
    ASSERT_TRUE(probe_surface(surfaces, {0.3, 0.0001, 0.6}, {0, 1, 0}, E));
    EXPECT_DOUBLE_EQ(E[0], 1);
    ASSERT_TRUE(probe_surface(surfaces, {0.3, 0.0004, 0.6}, {0, 1, 0}, E));
    EXPECT_DOUBLE_EQ(E[0], 2);
}

TEST(SurfaceProbe, finds_what_a_search_of_all_triangles_finds) {
    const Solution s = linear_room(20);
    const Surfaces surfaces(s, Backs::black);
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto [u, v] = low_discrepancy(11, i);
        const Vec3 p{4 * u, 0.002, 5 * v};
        const auto place = find_surface(surfaces, p, {0, 1, 0});
        ASSERT_TRUE(place.has_value());
        const auto corners = surfaces.corners(place->triangle);
        const Vec3 found = corners[0] * place->weights[0] + corners[1] * place->weights[1] +
                           corners[2] * place->weights[2];
        // The foot of the point on the floor; float positions of 5 m have steps of 5e-7 m.
        EXPECT_NEAR(length(found - p), 0.002, 1e-6);
    }
}

}  // namespace
}  // namespace exitance
