// SPDX-License-Identifier: Apache-2.0
// Where walls meet floors: no light gets through, and no dark line runs along them.
#include <gtest/gtest.h>

#include "exitance/formfactor/point_polygon.h"
#include "exitance/math/polygon.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_square;
using exitance::testing::add_surface;

// A house [0, 2 + far] × [0, 1] × [0, 1] whose floor, ceiling and long walls are single polygons,
// with a two-sided partition at x = 1 + shift that meets them without sharing a corner, and a lamp
// in the room x < 1.
struct House {
    Scene scene;
    double partition;

    House(double shift, double rho, std::uint32_t patches) : partition(1 + shift) {
        add_room(scene, {}, {2.1, 1, 1}, rho);
        for (Polygon& p : scene.polygons) p.patches = patches;
        const auto wall = add_surface(scene, "partition", rho);
        scene.materials.back().two_sided = true;
        const double x = partition;
        add_polygon(scene, wall, {{x, 0, 0}, {x, 1, 0}, {x, 1, 1}, {x, 0, 1}});
        add_lamp(scene, "lamp", {0.5, 0.5, 0.97}, 0.3, {10, 10, 10});
    }
};

class Partition : public ::testing::TestWithParam<std::tuple<double, std::uint32_t>> {};

// Irradiance of the vertices of the room beyond the partition. Those on its foot belong to both.
std::vector<double> beyond(const House& house, const Solution& solution) {
    std::vector<double> out;
    for (std::size_t v = 0; v < solution.positions.size(); ++v) {
        const Vec3 p(solution.positions[v]);
        const bool back_of_partition =
            std::abs(p.x - house.partition) < 1e-6 && solution.normals[v].x > 0.5f;
        if (p.x > house.partition + 1e-6 || back_of_partition)
            out.push_back(double(solution.irradiance[VertexId(v)][0]));
    }
    return out;
}

TEST_P(Partition, LetsNoDirectLightThrough) {
    const auto [shift, patches] = GetParam();
    const House house(shift, 0, patches);
    SolveOptions options;
    options.error = 0.05;
    options.adaptive = patches == 0;  // black surfaces are not refined anyway
    const auto dark = beyond(house, light(house.scene, options));
    EXPECT_GT(dark.size(), 30u);
    for (const double H : dark) EXPECT_EQ(H, 0);
}

// Elements that lie under the partition have light of one room and shoot it into both; refinement
// keeps them small.
TEST_P(Partition, LetsLittleReflectedLightThrough) {
    const auto [shift, patches] = GetParam();
    const House house(shift, 0.7, patches);
    SolveOptions options;
    options.error = 0.05;
    const Solution solution = light(house.scene, options);
    double bright = 0, dark = 0;  // fluxes through the floor
    const std::vector<double> areas = vertex_areas(solution);
    for (std::size_t v = 0; v < areas.size(); ++v) {
        const Vec3 p(solution.positions[v]);
        if (p.z > 1e-6 || solution.normals[v].z < 0.5f) continue;
        (p.x < house.partition + 1e-6 ? bright : dark) +=
            areas[v] * double(solution.irradiance[VertexId(v)][0]);
    }
    EXPECT_GT(bright, 0.1);
    EXPECT_LT(dark, 1e-4 * bright) << dark / bright;
}

// At a patch boundary (0.05), between two (0), and a hair beside one.
INSTANTIATE_TEST_SUITE_P(Where, Partition,
                         ::testing::Combine(::testing::Values(0.0, 0.05, 0.05001),
                                            ::testing::Values(0u, 8u)));

// Two rooms with floors of their own, which meet below the wall: the direct light at its foot is
// that of the open floor, from inside.
TEST(Contact, RoomsWithFloorsOfTheirOwnShareNoLight) {
    Scene scene;
    add_room(scene, {}, {1, 1, 1}, 0.7);
    add_room(scene, {1, 0, 0}, {2, 1, 1}, 0.7);
    add_lamp(scene, "lamp", {0.5, 0.5, 0.97}, 0.3, {10, 10, 10});
    SolveOptions options;
    options.error = 0.05;
    const Solution solution = light(scene, options);
    const SolutionPart& other = solution.parts[1];
    for (std::uint32_t t = other.first_triangle; t < other.first_triangle + other.triangles; ++t)
        for (const std::uint32_t v : solution.triangles[t])
            ASSERT_EQ(solution.irradiance[VertexId(v)][0], 0.0f)
                << solution.positions[v].x << " " << solution.positions[v].y << " "
                << solution.positions[v].z;
}

TEST(Contact, NoDarkLineAtTheFootOfAWall) {
    Scene scene;
    add_room(scene, {}, {1, 1, 1}, 0);
    add_room(scene, {1, 0, 0}, {2, 1, 1}, 0);
    const std::array<Vec3, 4> lamp{
        {{0.35, 0.35, 0.97}, {0.35, 0.65, 0.97}, {0.65, 0.65, 0.97}, {0.65, 0.35, 0.97}}};
    add_lamp(scene, "lamp", {0.5, 0.5, 0.97}, 0.3, {10, 10, 10});
    SolveOptions options;
    options.error = 0.02;
    options.merge = false;
    const Solution solution = light(scene, options);
    std::size_t feet = 0, corners = 0;
    for (std::size_t v = 0; v < solution.positions.size(); ++v) {
        const Vec3 p(solution.positions[v]), n(solution.normals[v]);
        const double H = double(solution.irradiance[VertexId(v)][0]);
        if (p.x > 1 + 1e-6 || (p.x > 1 - 1e-6 && n.x > 0.5)) {
            EXPECT_EQ(H, 0) << "the other room";
            continue;
        }
        // The floor of both rooms is one surface each, whose vertices at x = 1 look alike: take
        // the brighter as that of the lit room.
        if (n.z < 0.5 || p.z > 1e-6) continue;
        const double exact = 10 * point_polygon_factor(p, n, lamp);
        const bool foot = p.x > 1 - 1e-6;
        if (foot && H == 0) continue;
        EXPECT_NEAR(H, exact, 0.01 * exact) << p.x << " " << p.y;
        feet += foot;
        corners += foot && (p.y < 1e-6 || p.y > 1 - 1e-6);
    }
    EXPECT_GT(feet, 3u);
    EXPECT_EQ(corners, 2u);
}

TEST(Contact, WallsAreLitDownToTheFloor) {
    // The foot of a lit wall, and the floor at it, from light that grazes neither.
    Scene scene;
    const auto floor = add_surface(scene, "floor", 0), wall = add_surface(scene, "wall", 0);
    add_polygon(scene, floor, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_polygon(scene, wall, {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
    const auto lamp = add_surface(scene, "lamp", 0, 10);
    add_polygon(scene, lamp, {{0, 0, 1}, {0, 1, 1}, {0.5, 1, 1}, {0.5, 0, 1}});
    SolveOptions options;
    options.error = 0.02;
    const Solution solution = light(scene, options);
    const std::array<Vec3, 4> source{{{0, 0, 1}, {0, 1, 1}, {0.5, 1, 1}, {0.5, 0, 1}}};
    std::size_t feet = 0;
    for (std::size_t v = 0; v < solution.positions.size(); ++v) {
        const Vec3 p(solution.positions[v]), n(solution.normals[v]);
        if (p.z > 1e-6 || p.x < 1 - 1e-6) continue;
        const double exact = 10 * point_polygon_factor(p, n, source);
        EXPECT_NEAR(double(solution.irradiance[VertexId(v)][0]), exact, 0.02 * exact)
            << "normal " << n.x << " " << n.z << " at y " << p.y;
        ++feet;
    }
    EXPECT_GT(feet, 6u);
}

// Two-sided posts, dark inside and too thin to cut the floor along them: outside of them no corner
// of the floor is drawn with the darkness within.
TEST(Posts, HaveNoDarkSpikesAroundTheirFeet) {
    Scene scene;
    add_room(scene, {}, {4, 4, 2.5}, 0.5);
    add_lamp(scene, "lamp", {2, 2, 2.45}, 1, {10, 10, 10});
    constexpr double half = 0.012;
    std::vector<Vec3> posts;
    for (const double x : {1, 2, 3})
        for (const double y : {1, 2, 3}) {
            posts.push_back({x, y, 0});
            const auto s = add_surface(scene, "post", 0.5);
            scene.materials.back().two_sided = true;
            const Vec3 a{x - half, y - half, 0}, b{x + half, y - half, 0}, c{x + half, y + half, 0},
                d{x - half, y + half, 0}, up{0, 0, 0.7};
            const std::array<std::array<Vec3, 2>, 4> sides{{{a, b}, {b, c}, {c, d}, {d, a}}};
            for (const auto& [from, to] : sides)
                add_polygon(scene, s, {from, to, to + up, from + up});
            add_polygon(scene, s, {a + up, b + up, c + up, d + up});
        }
    // So coarse that each post stands on a corner of elements and is thinner than what is cut.
    SolveOptions options;
    options.error = 0.3;
    options.patch_size = 0.5;
    options.adaptive = false;
    const Solution solution = light(scene, options);
    const auto level = [&](std::uint32_t v) { return double(solution.irradiance[VertexId(v)][0]); };
    const auto inside = [&](const Vec3& p) {
        return std::ranges::any_of(posts, [&](const Vec3& post) {
            return std::abs(p.x - post.x) < half && std::abs(p.y - post.y) < half;
        });
    };
    std::size_t floor = 0, within = 0, dark = 0;
    for (const auto& t : solution.triangles)
        for (const std::uint32_t v : t) {
            const Vec3 p(solution.positions[v]);
            if (p.z > 1e-6 || solution.normals[v].z < 0.5f) continue;
            ++floor;
            within += inside(p) ? 1 : 0;
            dark += level(v) < 0.1 ? 1 : 0;
        }
    EXPECT_GT(floor, 300u);
    EXPECT_GE(within, 9u * 4);
    EXPECT_EQ(dark, 0u);
}

}  // namespace
}  // namespace exitance
