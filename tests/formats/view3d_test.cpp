// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/view3d.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;

const std::string points = "V 1 0 0 0\nV 2 4 0 0\nV 3 4 3 0\nV 4 0 3 0\n";
const std::string window = "V 5 1 1 0\nV 6 2 1 0\nV 7 2 2 0\nV 8 1 2 0\n";

Scene parse(const std::string& text) {
    return parse_view3d("t.vs3", text);
}

double area_of(const Scene& scene, std::uint32_t surface) {
    double sum = 0;
    for (const Polygon& polygon : scene.polygons)
        if (polygon.surface == surface) sum += scene.area(polygon);
    return sum;
}

TEST(View3d, SurfacesAndOptions) {
    const Scene scene = parse(
        "T two plates\n! a comment\nC eps=1e-4 maxU=12 encl=0\nC out=1 ! more\nF 3\n" + points +
        "/ another\nS 1 1 2 3 4 0 0 0.75 floor\nS 2 1 3 2 0 0 1 0.75 half ! of it\n"
        "End of data\nnonsense\n");
    EXPECT_EQ(scene.title, "two plates");
    ASSERT_EQ(scene.polygons.size(), 2U);
    EXPECT_EQ(scene.polygons[0].size(), 4U);
    EXPECT_EQ(scene.polygons[0].line, 11U);
    EXPECT_EQ(scene.polygons[1].size(), 3U);
    EXPECT_EQ(scene.normal(scene.polygons[0]), Vec3(0, 0, 1));
    EXPECT_EQ(scene.surfaces[0].name, "floor");
    EXPECT_EQ(scene.surfaces[1].name, "half");
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(3, 0.25));  // 1 − emissivity
    const FormFactorSetup& setup = scene.form_factors;
    const std::vector<std::pair<std::string, std::string>> options{
        {"eps", "1e-4"}, {"maxU", "12"}, {"encl", "0"}, {"out", "1"}};
    EXPECT_EQ(setup.options, options);
    ASSERT_EQ(setup.surfaces.size(), 2U);
    EXPECT_FALSE(setup.surfaces[0].combine);
    EXPECT_EQ(setup.surfaces[1].combine, 0U);
    EXPECT_EQ(setup.surfaces[1].surface, 1U);
    EXPECT_EQ(setup.surfaces[1].emissivity, 0.75);
}

TEST(View3d, SubsurfacesAreCutOutOfTheirBase) {
    const Scene scene =
        parse("F 3\n" + points + window + "S 1 1 2 3 4 0 0 0.5 wall\nS 2 5 6 7 8 1 0 0.9 window\n");
    EXPECT_NEAR(area_of(scene, 0), 11, 1e-12);
    EXPECT_NEAR(area_of(scene, 1), 1, 1e-12);
    for (const Polygon& polygon : scene.polygons) EXPECT_EQ(scene.normal(polygon), Vec3(0, 0, 1));
    EXPECT_EQ(scene.form_factors.surfaces[1].base, 0U);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(View3d, RolesOfSurfaces) {
    const Scene scene = parse("F 3\n" + points + window +
                              "S 1 1 2 3 4 0 0 0.5 wall\nN 2 5 6 7 8 1 0 1 hole\n"
                              "O 3 1 2 3 4 0 0 0.5 screen\nM 4 5 6 7 0 3 0 1 mask\n");
    const auto& surfaces = scene.form_factors.surfaces;
    EXPECT_EQ(surfaces[1].role, FormFactorRole::null);
    EXPECT_EQ(surfaces[2].role, FormFactorRole::obstruction);
    EXPECT_EQ(surfaces[3].role, FormFactorRole::mask);
    EXPECT_NEAR(area_of(scene, 0), 11, 1e-12);
    EXPECT_EQ(area_of(scene, 1), 0);
    EXPECT_NEAR(area_of(scene, 2), 11.5, 1e-12);
    EXPECT_EQ(area_of(scene, 3), 0);
    EXPECT_EQ(scene.materials[scene.surfaces[2].material].reflectance, Spectrum(3, 0.0));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].what.find("mask"), std::string::npos);
}

TEST(View3d, BadInputIsRefusedWithItsPlace) {
    const auto expect = [](const std::string& text, const std::string& place,
                           const std::string& words) {
        expect_refused([&] { parse(text); }, place, words);
    };
    expect("X\n", "t.vs3:1:1", "expected T, C, F");
    expect("C eps\n", "t.vs3:1:3", "key=value");
    expect("F 4\n", "t.vs3:1:3", "3 or 3a");
    expect("V 1 0 x 0\n", "t.vs3:1:7", "a coordinate");
    expect("V 1 0 0 0\nV 1 0 0 1\n", "t.vs3:2:3", "already a vertex 1");
    expect("S 1 1 2 3 0 0 0 1 a\n", "t.vs3:1:5", "no vertex 1");
    expect(points + "S 1 1 2 3 4 0 0 2 a\n", "t.vs3:5:17", "an emissivity");
    expect(points + "S 1 1 2 3 4 7 0 1 a\n", "t.vs3:5:3", "base 7");
    expect(points + "S 1 1 2 3 4 1 0 1 a\n", "t.vs3:5:3", "its own base");
    expect(points + "S 1 1 2 3 4\n", "t.vs3:5:12", "the number of the base");
}

}  // namespace
}  // namespace exitance
