// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/mend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/math/polygon.h"
#include "scene/small_scenes.h"

namespace exitance {
namespace {

using testing::add_polygon;
using testing::add_square;
using testing::add_surface;

TEST(Mend, LeavesSoundPolygonsAlone) {
    Scene scene;
    add_surface(scene, "wall", 0.9);
    add_square(scene, 0, 0, 0, 0).patches = 9;
    add_polygon(scene, 0, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    mend(scene);
    EXPECT_EQ(scene.polygons.size(), 2U);
    EXPECT_EQ(scene.polygons[0].patches, 9U);
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(3, 0.9));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Mend, SplitsBentQuadsAlongOneDiagonal) {
    Scene scene;
    add_surface(scene, "roof");
    Polygon& quad = add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}});
    quad.line = 5;
    quad.patches = 5;
    mend(scene);
    ASSERT_EQ(scene.polygons.size(), 2U);
    for (const Polygon& polygon : scene.polygons) {
        EXPECT_EQ(polygon.size(), 3U);
        EXPECT_EQ(polygon.patches, 3U);  // half of five, rounded up
        EXPECT_GT(scene.normal(polygon).z, 0);
    }
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].place.text(), "s.geom:5");
    EXPECT_EQ(scene.warnings[0].what,
              "a polygon of 'roof' is not planar and is split into two triangles");
}

TEST(Mend, SplitsDentedQuadsAtTheDent) {
    // An arrow head with its dent at each of the four corners in turn: area 1, split into halves.
    const std::array<Vec3, 4> arrow{Vec3{0, 0, 0}, Vec3{2, -1, 0}, Vec3{1, 0, 0}, Vec3{2, 1, 0}};
    for (std::size_t first = 0; first < 4; ++first) {
        Scene scene;
        add_surface(scene, "arrow");
        add_polygon(
            scene, 0,
            {arrow[first], arrow[(first + 1) % 4], arrow[(first + 2) % 4], arrow[(first + 3) % 4]});
        mend(scene);
        ASSERT_EQ(scene.polygons.size(), 2U) << first;
        for (const Polygon& polygon : scene.polygons) {
            EXPECT_NEAR(scene.area(polygon), 0.5, 1e-15);
            EXPECT_NEAR(scene.normal(polygon).z, 1, 1e-15);
        }
        EXPECT_NE(scene.warnings.at(0).what.find("not convex"), std::string::npos);
    }
}

TEST(Mend, DropsWhatHasNoAreaAndRepeatedCorners) {
    Scene scene;
    add_surface(scene, "wall");
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}});  // a triangle
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}});  // a triangle
    add_polygon(scene, 0, {{0, 0, 0}, {0, 0, 0}, {1, 1, 0}, {1, 1, 0}});  // a line
    add_polygon(scene, 0, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});             // a point
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}});             // a line
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}});  // a line
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}});        // thinner than float
    mend(scene);
    ASSERT_EQ(scene.polygons.size(), 2U);
    EXPECT_EQ(scene.polygons[0].size(), 3U);
    EXPECT_EQ(scene.polygons[1].size(), 3U);
    EXPECT_NEAR(scene.area(scene.polygons[1]), 0.5, 1e-15);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].what, "5 polygons of 'wall' have no area and are left out");
}

TEST(Mend, RoundingOfSixDigitsIsPlanar) {
    Scene scene;
    add_surface(scene, "panel");
    // A slanted panel with corners kept in six decimals.
    add_polygon(scene, 0, {{0, 0, 0}, {1, 0.333333, 0}, {1, 1.333333, 0.666667}, {0, 1, 0.666667}});
    mend(scene);
    EXPECT_EQ(scene.polygons.size(), 1U);
}

TEST(Mend, LimitsReflectancesOncePerMaterial) {
    Scene scene;
    add_surface(scene, "mirror", 1);
    add_square(scene, 0, 0, 0, 0);
    scene.materials[0].reflectance = {0.3, 0.99, 1};
    mend(scene);
    EXPECT_EQ(scene.materials[0].reflectance, (Spectrum{0.3, 0.98, 0.98}));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].place.text(), "s.geom:7:3");
}

TEST(Mend, RefusesWhatHasNoMeaning) {
    const auto refuses = [](const auto& spoil) {
        Scene scene;
        add_surface(scene, "wall");
        add_square(scene, 0, 0, 0, 0);
        spoil(scene);
        EXPECT_THROW(mend(scene), Error);
    };
    refuses([](Scene& s) { s.points[2].y = std::nan(""); });
    refuses([](Scene& s) { s.points[2].y = -INFINITY; });
    refuses([](Scene& s) { s.points[2].y = 1e10; });
    refuses([](Scene& s) { s.materials[0].reflectance[0] = 1.01; });
    refuses([](Scene& s) { s.materials[0].reflectance[0] = -0.01; });
    refuses([](Scene& s) { s.materials[0].reflectance[0] = std::nan(""); });
    refuses([](Scene& s) { s.materials[0].exitance[0] = -1; });
    refuses([](Scene& s) { s.materials[0].exitance[0] = INFINITY; });
}

}  // namespace
}  // namespace exitance
