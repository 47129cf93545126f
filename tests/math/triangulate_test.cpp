// SPDX-License-Identifier: Apache-2.0
#include "exitance/math/triangulate.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "exitance/math/polygon.h"

namespace exitance {
namespace {

using Outline = std::vector<Vec3>;

// Sum of the triangles' areas, each of which must face as the outline does.
double covered(const Outline& outline, const Triangulation& cut) {
    const Vec3 normal = unit_normal(outline);
    double sum = 0;
    for (const auto& t : cut.triangles) {
        const Outline three{outline[t[0]], outline[t[1]], outline[t[2]]};
        EXPECT_GT(dot(vector_area(three), normal), 0);
        sum += area(three);
    }
    return sum;
}

TEST(Triangulate, ConvexOutlinesGiveTwoTrianglesLessThanCorners) {
    for (const std::uint32_t n : {3U, 4U, 5U, 12U, 100U}) {
        Outline outline;
        for (std::uint32_t i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * i / n;
            outline.push_back({std::cos(angle), 2, std::sin(angle)});
        }
        const Triangulation cut = triangulate(outline);
        EXPECT_TRUE(cut.simple);
        EXPECT_EQ(cut.triangles.size(), n - 2);
        EXPECT_NEAR(covered(outline, cut), area(outline), 1e-12);
    }
}

TEST(Triangulate, AnL) {
    const Outline outline{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const Triangulation cut = triangulate(outline);
    EXPECT_TRUE(cut.simple);
    EXPECT_EQ(cut.triangles.size(), 4U);
    EXPECT_NEAR(covered(outline, cut), 5, 1e-12);
}

TEST(Triangulate, CornersInALineAndCornersThatRepeat) {
    const Outline line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_NEAR(covered(line, triangulate(line)), 2, 1e-12);
    const Outline repeated{{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}};
    const Triangulation cut = triangulate(repeated);
    EXPECT_TRUE(cut.simple);
    EXPECT_EQ(cut.triangles.size(), 2U);
    EXPECT_NEAR(covered(repeated, cut), 2, 1e-12);
}

TEST(Triangulate, WithoutAreaThereAreNone) {
    EXPECT_TRUE(triangulate(Outline{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).triangles.empty());
    EXPECT_TRUE(triangulate(Outline{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).triangles.empty());
    EXPECT_TRUE(triangulate(Outline{}).triangles.empty());
}

TEST(Triangulate, AHoleJoinedByASeam) {
    // A wall of 4 × 3 with a window of 2 × 1; the seam is walked in both directions.
    const Outline wall{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}, {0, 0, 0},
                       {1, 1, 0}, {1, 2, 0}, {3, 2, 0}, {3, 1, 0}, {1, 1, 0}};
    const Triangulation cut = triangulate(wall);
    EXPECT_TRUE(cut.simple);
    EXPECT_NEAR(covered(wall, cut), 4 * 3 - 2 * 1, 1e-12);
}

TEST(Triangulate, HolesAreJoinedInAnyOrderAndDirection) {
    const Outline outer{{0, 0, 1}, {10, 0, 1}, {10, 6, 1}, {0, 6, 1}};
    std::vector<Outline> loops{outer};
    for (int i = 0; i < 4; ++i) {
        const double x = 1 + 2.25 * i, y = i % 2 == 0 ? 1 : 3;
        loops.push_back({{x, y, 1}, {x, y + 2, 1}, {x + 1, y + 2, 1}, {x + 1, y, 1}});
    }
    std::reverse(loops[2].begin(), loops[2].end());
    std::swap(loops[1], loops[4]);
    std::vector<Vec3> all;
    for (const Outline& loop : loops) all.insert(all.end(), loop.begin(), loop.end());
    Outline joined;
    for (const std::uint32_t i : join_holes(loops)) joined.push_back(all[i]);
    ASSERT_EQ(joined.size(), 4 + 4 * (4 + 2));
    const Triangulation cut = triangulate(joined);
    EXPECT_TRUE(cut.simple);
    EXPECT_NEAR(covered(joined, cut), 60 - 4 * 2, 1e-12);
}

TEST(Triangulate, AnOutlineThatCrossesItselfIsTold) {
    const Outline bow{{0, 0, 0}, {4, 3, 0}, {4, 0, 0}, {0, 2, 0}, {-1, 1, 0}};
    EXPECT_FALSE(triangulate(bow).simple);
}

// Star-shaped outlines are simple, whatever their radii, in any plane.
RC_GTEST_PROP(Triangulate, StarsAreCoveredExactly, ()) {
    const int n = *rc::gen::inRange(3, 80);
    const int tilt = *rc::gen::inRange(0, 100);
    Outline outline;
    const Vec3 u = normalized(Vec3{1, 0.01 * tilt, 0.3});
    const Vec3 v = normalized(cross(Vec3{0.2, 0.5, 1}, u));
    for (int i = 0; i < n; ++i) {
        const double r = *rc::gen::inRange(1, 100);
        const double angle = 2 * std::numbers::pi * i / n;
        outline.push_back(u * (r * std::cos(angle)) + v * (r * std::sin(angle)));
    }
    const Triangulation cut = triangulate(outline);
    RC_ASSERT(cut.simple);
    double sum = 0;
    for (const auto& t : cut.triangles)
        sum += area(Outline{outline[t[0]], outline[t[1]], outline[t[2]]});
    RC_ASSERT(std::abs(sum - area(outline)) <= 1e-9 * area(outline));
}

// Whatever is given, it ends, with at most two triangles less than corners.
RC_GTEST_PROP(Triangulate, AnythingEnds, ()) {
    const int n = *rc::gen::inRange(0, 40);
    Outline outline;
    for (int i = 0; i < n; ++i)
        outline.push_back({static_cast<double>(*rc::gen::inRange(-3, 4)),
                           static_cast<double>(*rc::gen::inRange(-3, 4)),
                           static_cast<double>(*rc::gen::inRange(0, 2))});
    RC_ASSERT(triangulate(outline).triangles.size() + 2 <=
              std::max<std::size_t>(outline.size(), 2));
}

}  // namespace
}  // namespace exitance
