// SPDX-License-Identifier: Apache-2.0
// A lamp that is drawn in the very plane of a ceiling shines as one that hangs a hair below it, and
// is all that is to be seen there.
#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/math/polygon.h"
#include "exitance/solution/surface_probe.h"
#include "exitance/solution/surfaces.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using solve_scenes::add_lamp;
using solve_scenes::add_room;

const Vec3 middle{1.1, 0.9, 2};
constexpr double side = 0.5;

struct Room {
    bool lamp_is_first = false, two_sided = false;
    double below = 0;  ///< the ceiling [m]

    Scene scene() const {
        Scene out;
        const Vec3 at = middle - Vec3{0, 0, below};
        if (lamp_is_first) add_lamp(out, "lamp", at, side, {40, 40, 40});
        add_room(out, {}, {3, 2, 2}, 0.6);
        out.materials.back().two_sided = two_sided;
        if (!lamp_is_first) add_lamp(out, "lamp", at, side, {40, 40, 40});
        return out;
    }
};

Solution lit(const Room& room, const std::string& solver = "gathering") {
    SolveOptions options;
    options.error = 0.03;
    options.solver = solver;
    return light(room.scene(), options);
}

double floor_irradiance(const Solution& solution, double x, double y) {
    const Surfaces surfaces(solution, Backs::open);
    std::vector<double> row(solution.columns());
    EXPECT_TRUE(probe_surface(surfaces, {x, y, 0}, {0, 0, 1}, row));
    return solution.luminance(row);
}

double area_at_lamp(const Solution& solution, bool emits, bool up) {
    double out = 0;
    const Surfaces surfaces(solution, Backs::open);
    for (const SolutionPart& part : solution.parts) {
        if (solution.materials[part.material].emits() != emits) continue;
        for (std::uint32_t k = 0; k < part.triangles; ++k) {
            const auto corners = surfaces.corners(part.first_triangle + k);
            const Vec3 off = centroid(corners) - middle;
            if (std::abs(off.z) < 1e-6 && (unit_normal(corners).z > 0) == up &&
                std::max(std::abs(off.x), std::abs(off.y)) < side / 2)
                out += area(corners);
        }
    }
    return out;
}

class FlushLamp : public ::testing::TestWithParam<Room> {};

TEST_P(FlushLamp, ShinesAsOneBelow) {
    Room near = GetParam();
    near.below = 0.002;
    const Solution flush = lit(GetParam()), below = lit(near);
    ASSERT_TRUE(flush.error);
    EXPECT_LE(flush.error->rms, 0.03 + flush.error->confidence);
    for (const auto& [x, y] : {std::pair{1.1, 0.9}, {0.3, 0.4}, {2.6, 1.7}}) {
        // Both are solved to 3 % of the mean, which no place here is below a third of.
        const double expected = floor_irradiance(below, x, y);
        EXPECT_NEAR(floor_irradiance(flush, x, y) / expected, 1, 0.1) << x << " " << y;
    }
    EXPECT_LT(std::abs(flush.energy.imbalance()), 0.03);
}

TEST_P(FlushLamp, IsAllThatIsSeenThere) {
    const Solution flush = lit(GetParam());
    EXPECT_NEAR(area_at_lamp(flush, true, false), side * side, 1e-5);
    EXPECT_EQ(area_at_lamp(flush, false, false), 0.0);
    // The other side of a two-sided ceiling has no lamp in it.
    EXPECT_NEAR(area_at_lamp(flush, false, true), GetParam().two_sided ? side * side : 0.0, 1e-5);
    double ceiling = 0;
    const Surfaces surfaces(flush, Backs::open);
    for (std::uint32_t t = 0; t < flush.triangles.size(); ++t) {
        const auto corners = surfaces.corners(t);
        if (centroid(corners).z > 2 - 1e-6 && unit_normal(corners).z < 0) ceiling += area(corners);
    }
    EXPECT_NEAR(ceiling, 3 * 2, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(, FlushLamp,
                         ::testing::Values(Room{false, false}, Room{true, false},
                                           Room{false, true}));

TEST(FlushLamps, OfOtherSolvers) {
    const double expected = floor_irradiance(lit({}), 1.1, 0.9);
    for (const char* solver : {"shooting", "jacobi", "southwell"})
        EXPECT_NEAR(floor_irradiance(lit({}, solver), 1.1, 0.9) / expected, 1, 0.1) << solver;
}

TEST(FlushLamps, SmallOnesAndThoseAcrossABorder) {
    Scene scene;
    add_room(scene, {}, {3, 2, 2}, 0.6);
    add_lamp(scene, "small", {2.5, 0.5, 2}, 0.02, {9000, 9000, 9000});
    add_lamp(scene, "half", {0, 1, 2}, 0.4, {40, 40, 40});  // half of it is outside
    SolveOptions options;
    options.error = 0.05;
    const Solution solution = light(scene, options);
    double ceiling = 0, lamps = 0;
    const Surfaces surfaces(solution, Backs::open);
    for (const SolutionPart& part : solution.parts)
        for (std::uint32_t k = 0; k < part.triangles; ++k) {
            const auto corners = surfaces.corners(part.first_triangle + k);
            if (centroid(corners).z < 2 - 1e-6) continue;
            (solution.materials[part.material].emits() ? lamps : ceiling) += area(corners);
        }
    EXPECT_NEAR(lamps, 0.02 * 0.02 + 0.4 * 0.4, 1e-5);
    EXPECT_NEAR(ceiling, 3 * 2 - 0.02 * 0.02 - 0.5 * 0.4 * 0.4, 1e-4);
}

}  // namespace
}  // namespace exitance
