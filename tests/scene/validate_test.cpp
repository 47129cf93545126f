// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exitance/math/frame.h"
#include "exitance/run/progress.h"
#include "exitance/run/random.h"
#include "exitance/scene/builtin_photometry.h"
#include "exitance/scene/coplanar.h"
#include "scene/lamps.h"
#include "scene/small_scenes.h"

namespace exitance {
namespace {

using testing::add_polygon;
using testing::add_square;
using testing::add_surface;

bool found(const std::vector<Problem>& problems, const std::string& words) {
    for (const Problem& problem : problems)
        if (problem.what.find(words) != std::string::npos) return true;
    return false;
}

Scene lamp_and_wall() {
    Scene scene;
    add_surface(scene, "wall");
    add_surface(scene, "lamp", 0, 10);
    add_square(scene, 0, 0, 0, 0);
    add_square(scene, 1, 0, 0, 3, 1, true);
    return scene;
}

TEST(Validate, ASoundSceneHasNoProblems) {
    EXPECT_TRUE(validate(lamp_and_wall()).empty());
}

TEST(Validate, FindsWhatIsMissing) {
    EXPECT_TRUE(found(validate({}), "no polygons"));
    Scene dark = lamp_and_wall();
    dark.polygons.pop_back();
    EXPECT_TRUE(found(validate(dark), "stays dark"));
}

TEST(Validate, FindsLuminairesThatAreFarAway) {
    Scene scene = lamp_and_wall();
    scene.polygons.pop_back();
    scene.luminaires.push_back(testing::hanging(testing::cosine_photometry(1), {0.5, 0.5, 1}));
    EXPECT_TRUE(validate(scene).empty()) << "it lights the scene";
    scene.luminaires.push_back(testing::hanging(testing::cosine_photometry(1), {500, 0, 0}));
    scene.luminaires.back().place = {"p.toml", 9, 1};
    const auto problems = validate(scene);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].place.text(), "p.toml:9:1");
    EXPECT_TRUE(found(problems, "'lamp' is far outside"));
}

TEST(Validate, FindsLuminairesThatShineThroughTheSurfaceTheyStandOn) {
    Scene scene = lamp_and_wall();
    const auto corners = scene.corners(scene.polygons[0]);
    const Vec3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const Vec3 middle = (corners[0] + corners[2]) / 2;
    const auto problems = [&](Photometry photometry, const Vec3& at, const Vec3& aim) {
        scene.luminaires = {testing::hanging(std::move(photometry), at)};
        const Frame frame(aim);
        scene.luminaires[0].nadir = aim;
        scene.luminaires[0].c0 = frame.to_world({1, 0, 0});
        return validate(scene);
    };
    const Photometry even = isotropic_photometry(), down = testing::cosine_photometry(1);
    for (const double before : {0.0, 0.0009, -0.0009})
        EXPECT_TRUE(found(problems(even, middle + normal * before, normal), "shines through it"))
            << before;
    EXPECT_TRUE(problems(even, middle + normal * 0.0011, normal).empty());
    // Beside it, in its plane.
    EXPECT_TRUE(problems(even, corners[0] + (corners[0] - corners[2]) * 0.01, normal).empty());
    // Mounted on it, buried in it, and turned to it.
    EXPECT_TRUE(problems(down, middle, normal).empty());
    EXPECT_TRUE(problems(down, middle + normal * 0.0009, normal).empty());
    EXPECT_FALSE(problems(down, middle - normal * 0.0009, normal).empty());
    EXPECT_FALSE(problems(down, middle + normal * 0.0009, -normal).empty());
}

TEST(Validate, FindsMaterialsThatKeepLightForEver) {
    for (const double rho : {1.0, 1.5, -0.1, std::nan("")}) {
        Scene scene = lamp_and_wall();
        scene.materials[0].reflectance[1] = rho;
        const auto problems = validate(scene);
        ASSERT_EQ(problems.size(), 1U) << rho;
        EXPECT_EQ(problems[0].place.text(), "s.geom:7:3");
        EXPECT_TRUE(found(problems, "'wall' has the reflectance"));
    }
}

TEST(Validate, FindsPolygonsThatCannotBeLit) {
    Scene scene = lamp_and_wall();
    add_polygon(scene, 0, {{5, 0, 0}, {6, 0, 0}, {7, 0, 0}}).line = 12;
    add_polygon(scene, 0, {{5, 5, 0}, {5, 5, 0}, {5, 5, 0}}).line = 13;
    add_polygon(scene, 0, {{0, 5, 0}, {1, 5, 0}, {1, 6, 0.1}, {0, 6, 0}}).line = 14;
    const auto problems = validate(scene);
    ASSERT_EQ(problems.size(), 2U);
    EXPECT_TRUE(found(problems, "2 polygons of 'wall' have no area"));
    EXPECT_EQ(problems[0].place.text(), "s.geom:12");
    EXPECT_TRUE(found(problems, "a polygon of 'wall' is not planar"));
    EXPECT_EQ(problems[1].place.text(), "s.geom:14");
}

TEST(Validate, FindsCoordinatesThatAreNoNumbers) {
    Scene scene = lamp_and_wall();
    scene.points[1].y = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(found(validate(scene), "no numbers"));
}

TEST(Overlaps, DuplicatesAreFoundWhereverTheyBegin) {
    Scene scene = lamp_and_wall();
    add_polygon(scene, 1, {{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, -0.0}});
    const FaceOverlaps overlaps = find_overlaps(scene);
    ASSERT_EQ(overlaps.duplicates.size(), 1U);
    EXPECT_EQ(overlaps.duplicates[0].first, 0U);
    EXPECT_EQ(overlaps.duplicates[0].second, 2U);
    EXPECT_TRUE(overlaps.overlaps.empty());
    EXPECT_TRUE(found(
        validate(scene),
        "'wall' and 'lamp' lie in the same place; 'lamp', which emits, is what counts there"));
}

TEST(Overlaps, BackToBackIsNoOverlap) {
    Scene scene = lamp_and_wall();
    add_square(scene, 0, 0, 0, 0, 1, true);        // the other side of the wall
    add_square(scene, 0, 0.2, 0.2, 0, 0.5, true);  // a box that stands on it
    const FaceOverlaps overlaps = find_overlaps(scene);
    EXPECT_TRUE(overlaps.duplicates.empty());
    // The box's underside and the back of the wall face the same way and do overlap.
    ASSERT_EQ(overlaps.overlaps.size(), 1U);
    EXPECT_EQ(overlaps.overlaps[0].first, 2U);
    EXPECT_EQ(overlaps.overlaps[0].second, 3U);
}

TEST(Overlaps, SmallInLargeTouchingAndApart) {
    const auto count = [](double x, double z, double size) {
        Scene scene;
        add_surface(scene, "wall");
        add_square(scene, 0, 0, 0, 0, 100);
        add_square(scene, 0, x, 3, z, size);
        return find_overlaps(scene).overlaps.size();
    };
    EXPECT_EQ(count(50, 0, 0.01), 1U);  // a small one inside
    EXPECT_EQ(count(99.9, 0, 1), 1U);   // a corner over the edge
    EXPECT_EQ(count(100, 0, 1), 0U);    // edge to edge
    EXPECT_EQ(count(50, 1e-7, 1), 1U);  // within rounding of float
    EXPECT_EQ(count(50, 1e-3, 1), 0U);  // a millimetre above
}

TEST(Overlaps, SlantedPlanesAreFoundToo) {
    // A square and a smaller one within it, turned by angles that fall anywhere.
    for (std::uint64_t k = 0; k < 200; ++k) {
        const double a = 6.28 * uniform(1, k), b = 3.14 * uniform(2, k), far = 20 * uniform(3, k);
        const Vec3 n{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)};
        const Vec3 u = normalized(cross(n, Vec3{0.3, 0.5, 0.8})), v = cross(n, u);
        const Vec3 o = n * far + u * uniform(4, k);
        Scene scene;
        add_surface(scene, "wall");
        add_polygon(scene, 0, {o - u - v, o + u - v, o + u + v, o - u + v});
        const Vec3 c = o + u * 0.3;
        add_polygon(scene, 0, {c - u * 0.1, c + v * 0.1, c + u * 0.1});
        const bool same_side = dot(scene.normal(scene.polygons[1]), n) > 0;
        EXPECT_EQ(find_overlaps(scene).overlaps.size(), same_side ? 1U : 0U) << k;
        std::swap(scene.polygons[1].corners[0], scene.polygons[1].corners[1]);
        EXPECT_EQ(find_overlaps(scene).overlaps.size(), same_side ? 0U : 1U) << k;
    }
}

// A floor of 160 000 tiles under one that covers all of them. Near-linear work takes about half
// a second; looking at all pairs would take an hour.
TEST(Overlaps, ManyFacesInOnePlaneTakeNearlyLinearTime) {
    Scene scene;
    add_surface(scene, "tiles");
    const int n = 400;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) add_square(scene, 0, i, j, 0);
    const Stopwatch watch;
    EXPECT_TRUE(find_overlaps(scene).overlaps.empty());
    EXPECT_LT(watch.seconds(), 30);
    add_square(scene, 0, 0.5, 0.5, 0, n - 1);
    const FaceOverlaps overlaps = find_overlaps(scene);
    EXPECT_FALSE(overlaps.complete);  // more than are told
    EXPECT_GE(overlaps.overlaps.size(), 1000U);
}

}  // namespace
}  // namespace exitance
