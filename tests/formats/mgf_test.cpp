// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numbers>

#include "exitance/scene/cie_observer.h"
#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::beside_project;
using testing::expect_refused;
using testing::Folder;

constexpr double pi = std::numbers::pi;

// A unit square facing +z: a b c d.
const std::string square = "v a =\n p 0 0 0\nv b =\n p 1 0 0\nv c =\n p 1 1 0\nv d =\n p 0 1 0\n";

Scene parse(const std::string& text, const ReadOptions& options = {}) {
    return parse_mgf("t.mgf", text, options);
}

std::size_t warned(const Scene& scene, const std::string& words) {
    return static_cast<std::size_t>(std::count_if(
        scene.warnings.begin(), scene.warnings.end(),
        [&](const Problem& problem) { return problem.what.find(words) != std::string::npos; }));
}

Place place_of_warning(const Scene& scene, const std::string& words) {
    for (const Problem& problem : scene.warnings)
        if (problem.what.find(words) != std::string::npos) return problem.place;
    ADD_FAILURE() << "no warning says: " << words;
    return {};
}

const Material& material(const Scene& scene, const std::string& name) {
    for (const Material& m : scene.materials)
        if (m.name == name) return m;
    ADD_FAILURE() << "no material " << name;
    return scene.materials.at(0);
}

double total_area(const Scene& scene) {
    double sum = 0;
    for (const Polygon& polygon : scene.polygons) sum += scene.area(polygon);
    return sum;
}

void expect_vector(const Vec3& v, const Vec3& expected, double tolerance = 1e-12) {
    EXPECT_NEAR(v.x, expected.x, tolerance);
    EXPECT_NEAR(v.y, expected.y, tolerance);
    EXPECT_NEAR(v.z, expected.z, tolerance);
}

void expect_bands(const Spectrum& s, double r, double g, double b, double tolerance = 1e-4) {
    ASSERT_EQ(s.size(), 3U);
    EXPECT_NEAR(s[0], r, tolerance);
    EXPECT_NEAR(s[1], g, tolerance);
    EXPECT_NEAR(s[2], b, tolerance);
}

TEST(Mgf, ASquare) {
    const Scene scene = parse("# a comment\n\nm grey =\n c\n rd .5\n" + square + "f a b c d\n");
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(scene.polygons[0].size(), 4U);
    EXPECT_EQ(scene.polygons[0].line, 14U);
    EXPECT_EQ(scene.points.size(), 4U);
    expect_vector(scene.normal(scene.polygons[0]), {0, 0, 1});
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "grey");
    EXPECT_EQ(scene.materials[0].place.line, 3U);
    EXPECT_TRUE(scene.materials[0].two_sided);
    expect_bands(scene.materials[0].reflectance, 0.5, 0.5, 0.5);
    EXPECT_EQ(scene.quantity, Quantity::unitless);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Mgf, UpIsZUnlessMoreLiesLevelAcrossY) {
    EXPECT_EQ(parse(square + "f a b c d\n").up, (Vec3{0, 0, 1}));
    EXPECT_EQ(parse("xf -rx -90\n" + square + "f a b c d\nxf\n").up, (Vec3{0, 1, 0}));
    EXPECT_EQ(parse(square + "f a b c d\nxf -rx -90\n" + square + "f a b c d\nxf\n").up,
              (Vec3{0, 0, 1}));
}

TEST(Mgf, LinesContinueAndEndAnyWay) {
    const Scene scene = parse(
        "v a =\r\np 0 0 0\r\nv b =\n p \\\n 1 \\\r\n 0 0\nv c =\n p 1 1\\\n\t0\n"
        "# a comment \\\n f nothing\nf a \\\n b c");
    ASSERT_EQ(scene.polygons.size(), 1U);
    expect_vector(scene.points[1], {1, 0, 0});
    expect_vector(scene.points[2], {1, 1, 0});
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Mgf, TheDefaultMaterialIsBlackAndTwoSided) {
    const Scene scene = parse(square + "f a b c\n");
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "unnamed");
    EXPECT_TRUE(scene.materials[0].two_sided);
    expect_bands(scene.materials[0].reflectance, 0, 0, 0, 0);
}

TEST(Mgf, SharesOfAMaterial) {
    const Scene scene = parse(
        "m all =\n sides 1\n rd .1\n td .2\n rs .3 .05\n ts .4 .07\n ir 1.5 0\n"
        "m lamp =\n ed 1000\n" +
        square + "m all\nf a b c d\nm lamp\nf a b c\n");
    const Material& all = material(scene, "all");
    EXPECT_FALSE(all.two_sided);
    expect_bands(all.reflectance, 0.1, 0.1, 0.1);
    expect_bands(all.diffuse_transmittance, 0.2, 0.2, 0.2);
    expect_bands(all.specular, 0.3, 0.3, 0.3);
    expect_bands(all.transmittance, 0.4, 0.4, 0.4);
    EXPECT_EQ(all.roughness, 0.05);
    EXPECT_EQ(all.refractive_index, 1.5);
    expect_bands(material(scene, "lamp").exitance, 1000, 1000, 1000, 0.01);
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    EXPECT_EQ(warned(scene, "rs of material 'all'"), 0U);  // nothing is wrong with it
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].what.find("rs of material 'all'"), std::string::npos);
    EXPECT_EQ(warned(scene, "td of material 'all'"), 1U);
    EXPECT_EQ(warned(scene, "rough transmission"), 1U);
    EXPECT_EQ(scene.warnings.size(), 2U);
}

TEST(Mgf, ColoursByChromaticityKeepTheirLuminance) {
    const Scene scene =
        parse("c red =\n cxy .5 .33\nm paint =\n c red\n rd .3\n" + square + "f a b c d\n");
    const Spectrum rho = scene.materials[0].reflectance;
    EXPECT_NEAR(luminance(rho), 0.3, 1e-9);
    const Spectrum expected = rgb_of(xyz_of_chromaticity(0.5, 0.33));
    for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(rho[b], 0.3 * expected[b], 1e-9);
    EXPECT_GT(rho[0], 2 * rho[1]);
}

TEST(Mgf, ColoursBySpectrumTemperatureAndMixture) {
    const Scene scene = parse(
        "c flat =\n cspec 380 780 5 5 5\nc warm =\n cct 2856\nc a =\n cxy .4476 .4074\n"
        "c e =\nc mixed =\n cmix 1 warm 3 e\n"
        "m flat =\n c flat\n rd .4\nm warm =\n c warm\n ed 100\nm a =\n c a\n ed 100\n"
        "m mixed =\n c mixed\n ed 100\n" +
        square + "m flat\nf a b c\nm warm\nf a b c\nm a\nf a b c\nm mixed\nf a b c\n");
    expect_bands(material(scene, "flat").reflectance, 0.4, 0.4, 0.4, 1e-5);
    const Spectrum warm = material(scene, "warm").exitance;
    const Spectrum a = material(scene, "a").exitance;
    // 2856 K is illuminant A: the table's four digits.
    expect_bands(warm, a[0], a[1], a[2], 0.5);
    EXPECT_GT(warm[0], 1.4 * warm[1]);
    // Weights count luminance: a quarter of warm, three quarters of white; a thousandth off,
    // because the adapted colour's luminance is put right for each colour by itself.
    expect_bands(material(scene, "mixed").exitance, (warm[0] + 300) / 4, (warm[1] + 300) / 4,
                 (warm[2] + 300) / 4, 0.2);
}

TEST(Mgf, ContextsAreCopiedEnteredAndChanged) {
    const Scene scene = parse("m a =\n rd .2\n sides 1\nm b = a\n rd .3\nm a\n td .1\n" + square +
                              "v e = c\n n 0 0 1\nm a\nf a b c\nm b\nf a b e\n");
    expect_bands(material(scene, "a").reflectance, 0.2, 0.2, 0.2);
    expect_bands(material(scene, "a").diffuse_transmittance, 0.1, 0.1, 0.1);
    expect_bands(material(scene, "b").reflectance, 0.3, 0.3, 0.3);
    EXPECT_FALSE(material(scene, "b").two_sided);
    EXPECT_TRUE(material(scene, "b").diffuse_transmittance.empty());
    expect_vector(scene.normals[scene.polygons[1].corners[2]], {0, 0, 1});
    expect_vector(scene.points[scene.polygons[1].corners[2]], {1, 1, 0});
}

TEST(Mgf, AMaterialThatIsDefinedAgainIsAnother) {
    const Scene scene = parse("m x =\n rd .2\n" + square +
                              "f a b c\nm x =\n rd .2\nf a c d\nm x =\n rd .6\nf a b d\n");
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].name, "x (2)");
    expect_bands(scene.material(scene.polygons[0]).reflectance, 0.2, 0.2, 0.2);
    expect_bands(scene.material(scene.polygons[1]).reflectance, 0.2, 0.2, 0.2);
    expect_bands(scene.material(scene.polygons[2]).reflectance, 0.6, 0.6, 0.6);
    EXPECT_EQ(place_of_warning(scene, "'x' is defined again").text(), "t.mgf:15");
    EXPECT_EQ(scene.warnings.size(), 1U);
}

TEST(Mgf, EnergyStaysBelowOne) {
    const Scene scene = parse(
        "m gold =\n c\n cxy .45 .43\n rd .9\n rs .2 .01\nm green =\n c\n"
        " cxy 0 .38\n rd .12\nm white =\n c\n rd .8\n rs .2 0\n" +
        square + "m gold\nf a b c\nm green\nf a b c\nm white\nf a b c\n");
    const Material& gold = material(scene, "gold");
    EXPECT_NEAR(luminance(gold.reflectance), 0.9 / 1.1, 1e-9);
    EXPECT_NEAR(luminance(gold.specular), 0.2 / 1.1, 1e-9);
    for (std::size_t b = 0; b < 3; ++b) EXPECT_LE(gold.reflectance[b] + gold.specular[b], 1 + 1e-9);
    const Material& green = material(scene, "green");
    EXPECT_NEAR(luminance(green.reflectance), 0.12, 1e-9);
    for (const double band : green.reflectance) EXPECT_GE(band, 0);
    EXPECT_EQ(warned(scene, "rd + td + rs + ts of material 'gold' is 1.1"), 1U);
    EXPECT_EQ(warned(scene, "colour of material 'gold'"), 1U);
    EXPECT_EQ(warned(scene, "colour of material 'green'"), 1U);
    EXPECT_EQ(warned(scene, "'white'"), 0U);
    expect_bands(material(scene, "white").reflectance, 0.8, 0.8, 0.8, 1e-4);
}

TEST(Mgf, TransformationsApplyFromLeftToRightAndFromInsideOut) {
    // (1, 0, 0) turned to (0, 1, 0), moved to (5, 1, 0); then scaled by 2 outside.
    const Scene scene =
        parse("xf -s 2\nxf -rz 90 -t 5 0 0\n" + square + "f a b c\nxf\nxf\nf a b c\n");
    expect_vector(scene.points[scene.polygons[0].corners[1]], {10, 2, 0});
    expect_vector(scene.points[scene.polygons[0].corners[2]], {8, 2, 0});
    expect_vector(scene.points[scene.polygons[1].corners[1]], {1, 0, 0});
    // Turns are counter-clockwise seen from the axis' end.
    const Scene turned = parse(square +
                               "v x =\n p 0 1 2\nxf -rx 90\nf a b x\nxf\nxf -ry 90\nf a b x\n"
                               "xf\nxf -i 3 -t 1 0 0\nf a b x\nxf\n");
    expect_vector(turned.points[turned.polygons[0].corners[2]], {0, -2, 1});
    expect_vector(turned.points[turned.polygons[1].corners[2]], {2, 1, 0});
    expect_vector(turned.points[turned.polygons[2].corners[2]], {3, 1, 2});
}

TEST(Mgf, MirrorsKeepTheFrontInFront) {
    const Scene scene = parse(square +
                              "v n =\n p 0 0 3\n n 0 0 1\nxf -mz\nf a b c d\nring n 0 1\n"
                              "sph a 1\nxf\n");
    expect_vector(scene.normal(scene.polygons[0]), {0, 0, -1});
    expect_vector(scene.normal(scene.polygons[1]), {0, 0, -1});
    for (std::size_t i = 17; i < scene.polygons.size(); ++i) {
        const Vec3 corner = scene.points[scene.polygons[i].corners[0]];
        EXPECT_GT(dot(scene.normal(scene.polygons[i]), corner), 0.5);
    }
}

TEST(Mgf, ArraysRepeatWithTheirNames) {
    const Scene scene = parse(square +
                              "o room\nxf -t 10 0 0 -a 3 -t 2 0 0\no chair\nf a b c d\no\nxf\n"
                              "xf -a 2 -t 0 1 0 -a 2 -t 0 0 1\nf a b c\nxf\no\n");
    ASSERT_EQ(scene.polygons.size(), 7U);
    for (std::uint32_t i = 0; i < 3; ++i) {
        expect_vector(scene.points[scene.polygons[i].corners[0]], {10.0 + 2 * i, 0, 0});
        EXPECT_EQ(scene.surfaces[scene.polygons[i].surface].name,
                  "room/chair[" + std::to_string(i) + "]");
    }
    EXPECT_EQ(scene.surfaces[scene.polygons[6].surface].name, "room[1,1]");
    expect_vector(scene.points[scene.polygons[4].corners[0]], {0, 0, 1});
    expect_vector(scene.points[scene.polygons[6].corners[0]], {0, 1, 1});
}

TEST(Mgf, ArraysWithinArrays) {
    const Scene scene =
        parse(square + "xf -a 3 -t 10 0 0\nxf -a 2 -t 0 10 0\nf a b c\nxf\nf a b d\nxf\n");
    EXPECT_EQ(scene.polygons.size(), 3 * (2 + 1));
    EXPECT_EQ(scene.bounds().upper, (Vec3{21, 11, 0}));
}

TEST(Mgf, NamesAreAHierarchy) {
    const Scene scene =
        parse("o room\no table\no leg\n" + square + "f a b c\no\nf a c d\no\no\nf a b d\n");
    EXPECT_EQ(scene.surfaces[scene.polygons[0].surface].name, "room/table/leg");
    EXPECT_EQ(scene.surfaces[scene.polygons[1].surface].name, "room/table");
    EXPECT_EQ(scene.surfaces[scene.polygons[2].surface].name, "unnamed");
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Mgf, FacesOfManyCorners) {
    const std::string corners =
        "v e =\n p 3 0 0\nv f =\n p 3 1 0\nv g =\n p 1 3 0\nv h =\n p 0 3 0\n";
    const Scene scene = parse(square + corners + "f a e f c g h\n");  // an L of area 5
    EXPECT_EQ(scene.polygons.size(), 4U);
    EXPECT_NEAR(total_area(scene), 5, 1e-12);
    for (const Polygon& polygon : scene.polygons) expect_vector(scene.normal(polygon), {0, 0, 1});
    // Concave with four corners, and one that is bent: the latter is left for mending.
    const Scene dart = parse(square + "v e =\n p .5 .1 0\nf a b e d\n");
    EXPECT_EQ(dart.polygons.size(), 2U);
    EXPECT_EQ(parse(square + "v e =\n p 1 1 .5\nf a b e d\n").polygons.size(), 1U);
}

TEST(Mgf, HolesBySeamsAndByName) {
    const std::string window =
        "v h1 =\n p .25 .25 0\nv h2 =\n p .25 .75 0\nv h3 =\n p .75 .75 0\nv h4 =\n p .75 .25 0\n";
    const Scene seam = parse(square + window + "f a b c d a h1 h2 h3 h4 h1\n");
    EXPECT_NEAR(total_area(seam), 0.75, 1e-12);
    EXPECT_TRUE(seam.warnings.empty());
    for (const char* order : {"h1 h2 h3 h4", "h4 h3 h2 h1"}) {
        const Scene named = parse(square + window + "fh a b c d - " + order + "\n");
        EXPECT_NEAR(total_area(named), 0.75, 1e-12);
        EXPECT_TRUE(named.warnings.empty());
    }
    const Scene plain = parse(square + "fh a b c d\n");
    EXPECT_EQ(plain.polygons.size(), 1U);
    expect_refused([&] { parse(square + "fh a b c - a b\n"); }, "t.mgf:9:15", "three vertices");
}

TEST(Mgf, OutlinesThatCrossAreTold) {
    const Scene scene = parse(square + "v e =\n p 2 .5 0\nf a c b e d\n");
    EXPECT_EQ(warned(scene, "crosses itself"), 1U);
    EXPECT_EQ(warned(parse(square + "v e =\n p 2 2 3\nf a b e c d\n"), "not in one plane"), 1U);
}

TEST(Mgf, NormalsSmoothButNeverDecideTheSide) {
    // Averaged over a box's corner (54.7° off): left out. Upside down: turned round. Good: kept.
    const Scene scene = parse(
        "v a =\n p 0 0 0\n n -1 -1 1\nv b =\n p 1 0 0\n n 0 0 -2\n"
        "v c =\n p 1 1 0\n n .1 0 1\nf a b c\n");
    expect_vector(scene.normal(scene.polygons[0]), {0, 0, 1});
    expect_vector(scene.normals[0], {0, 0, 0});
    expect_vector(scene.normals[1], {0, 0, 1});
    expect_vector(scene.normals[2], normalized(Vec3{0.1, 0, 1}));
    EXPECT_EQ(place_of_warning(scene, "more than 45°").line, 10U);
}

TEST(Mgf, CurvedBodiesHaveTheAreaOfTheirFacets) {
    const std::string vertices = "v a =\n p 1 2 3\n n 0 0 1\nv b =\n p 1 2 5\n";
    // n = 16 facets a turn at the default tolerance of 0.02.
    const double chord = std::sin(pi / 16), apothem = std::cos(pi / 16);
    const auto area = [&](const std::string& body) { return total_area(parse(vertices + body)); };
    EXPECT_NEAR(area("cyl a .5 b\n"), 16 * 2 * 0.5 * chord * 2, 1e-12);
    EXPECT_NEAR(area("cone a 1 b 0\n"), 16 * chord * std::hypot(2, apothem), 1e-12);
    EXPECT_NEAR(area("ring a 1 2\n"), 8 * std::sin(pi / 8) * 3, 1e-12);
    EXPECT_EQ(parse(vertices + "sph a 1\n").polygons.size(), 16 * 8);
    EXPECT_EQ(parse(vertices + "torus a 1 2\n").polygons.size(), 16 * 16);
    ReadOptions fine;
    fine.tolerance = 1e-4;
    EXPECT_NEAR(total_area(parse(vertices + "sph a 1\n", fine)), 4 * pi, 4 * pi * 1e-3);
    EXPECT_NEAR(total_area(parse(vertices + "torus a 1 2\n", fine)), 4 * pi * pi * 1.5 * 0.5,
                4 * pi * pi * 0.75 * 1e-3);
    EXPECT_NEAR(total_area(parse(vertices + "cone a 2 b 1\n", fine)), 3 * pi * std::hypot(2, 1),
                3 * pi * std::hypot(2, 1) * 1e-3);
}

TEST(Mgf, CurvedBodiesFaceOutwardAndWithNegativeRadiiInward) {
    const std::string vertices = "m x =\n sides 1\nv a =\n p 0 0 0\n n 0 0 1\nv b =\n p 0 0 2\n";
    const auto outward = [&](const std::string& body) {
        const Scene scene = parse(vertices + body);
        double sum = 0;
        for (const Polygon& polygon : scene.polygons) {
            const auto at = scene.corners(polygon);
            const Vec3 c = (at[0] + at[1]) * 0.5;
            const Vec3 from_axis = body[0] == 's' ? c : Vec3{c.x, c.y, 0};
            const double along = dot(scene.normal(polygon), from_axis);
            EXPECT_GT(dot(scene.normal(polygon), scene.normals[polygon.corners[0]]), 0.7);
            sum += along;
        }
        return sum;
    };
    EXPECT_GT(outward("sph a 1\n"), 0);
    EXPECT_LT(outward("sph a -1\n"), 0);
    EXPECT_GT(outward("cyl a 1 b\n"), 0);
    EXPECT_LT(outward("cyl a -1 b\n"), 0);
    EXPECT_GT(outward("cone a 2 b 1\n"), 0);
    EXPECT_LT(outward("cone a -2 b -1\n"), 0);
    EXPECT_LT(outward("cone a -2 b 0\n"), 0);
    EXPECT_GT(outward("torus a 0.5 1\n"), 0);
    EXPECT_LT(outward("torus a -0.5 -1\n"), 0);
}

TEST(Mgf, APrismGrowsAgainstTheNormalOfItsFace) {
    const Scene scene = parse(square + "m x =\n sides 1\nprism a b c d 2\n");
    ASSERT_EQ(scene.polygons.size(), 6U);
    EXPECT_EQ(scene.bounds().lower, (Vec3{0, 0, -2}));
    EXPECT_EQ(scene.bounds().upper, (Vec3{1, 1, 0}));
    EXPECT_NEAR(total_area(scene), 2 + 4 * 2, 1e-12);
    const auto outward = [](const Scene& s) {
        const Vec3 middle = s.bounds().centre();
        double least = 1, most = -1;
        for (const Polygon& polygon : s.polygons) {
            const auto c = s.corners(polygon);
            const double along = dot(s.normal(polygon), (c[0] + c[2]) * 0.5 - middle);
            least = std::min(least, along);
            most = std::max(most, along);
        }
        return std::pair(least, most);
    };
    EXPECT_GT(outward(scene).first, 0);
    const Scene inward = parse(square + "m x =\n sides 1\nprism a b c d -2\n");
    EXPECT_EQ(inward.bounds().upper, (Vec3{1, 1, 2}));
    EXPECT_LT(outward(inward).second, 0);
}

TEST(Mgf, CurvedLampsEmitTheFluxOfTheTrueSurface) {
    const Scene scene = parse(
        "m lamp =\n sides 1\n ed 100\nv a =\n p 0 0 0\nv b =\n p 0 0 2\n"
        "cyl a .5 b\nsph b .25\n");
    double flux = 0;
    for (const Polygon& polygon : scene.polygons)
        flux += scene.area(polygon) * luminance(scene.material(polygon).exitance);
    EXPECT_NEAR(flux, 100 * (2 * pi * 0.5 * 2 + 4 * pi * 0.25 * 0.25), 0.05);  // factor to 1e-4
}

TEST(Mgf, TwoSidedLampsDoNotShineIntoClosedBodies) {
    // A lamp in a room of 10 m; the room is two-sided too and stays so.
    const Scene scene = parse("m wall =\n rd .5\n" + square +
                              "xf -s 10\nprism a b c d 1\nxf\nm lamp =\n ed 100\nv m =\n p 5 5 -5\n"
                              "sph m .5\n");
    for (const Polygon& polygon : scene.polygons)
        EXPECT_EQ(scene.material(polygon).two_sided, !scene.material(polygon).emits());
    EXPECT_EQ(place_of_warning(scene, "'lamp' is two-sided and would emit into").line, 14U);
    // A cylinder is open without its ends, and closed with them.
    const std::string tube = "m wall =\n rd .5\n" + square +
                             "xf -s 10\nprism a b c d 1\nxf\nm lamp =\n ed 100\nv m =\n p 5 5 -5\n"
                             " n 0 0 -1\nv n =\n p 5 5 -4\n n 0 0 1\ncyl m .2 n\n";
    EXPECT_EQ(warned(parse(tube), "would emit into"), 0U);
    EXPECT_EQ(warned(parse(tube + "m cap =\nring m 0 .2\nring n 0 .2\n"), "would emit into"), 1U);
}

TEST(Mgf, IncludesAreReadBesideTheFile) {
    const Folder folder;
    folder.write("parts/leg.mgf", square + "f a b c d\n");
    folder.write("parts/table.mgf", "o table\ni leg.mgf -t 0 0 1\no\n");
    const auto file = folder.write("room.mgf",
                                   "m wood =\n rd .4\no room\n"
                                   "i parts/table.mgf -a 2 -t 5 0 0\no\nf a b c\n");
    const Scene scene = read_scene(file);
    ASSERT_EQ(scene.polygons.size(), 3U);
    EXPECT_EQ(scene.surfaces[scene.polygons[1].surface].name, "room/table[1]");
    expect_vector(scene.points[scene.polygons[1].corners[0]], {5, 0, 1});
    EXPECT_EQ(scene.materials.size(), 1U);
    // Vertices of an included file are known after it, where they stand: not moved.
    expect_vector(scene.points[scene.polygons[2].corners[1]], {1, 0, 0});
}

TEST(Mgf, IncludesComeToAnEnd) {
    const Folder folder;
    const auto self = folder.write("self.mgf", "# itself\ni self.mgf\n");
    expect_refused([&] { read_scene(self); }, self.string() + ":2:3", "includes itself");
    const auto gone = folder.write("gone.mgf", "i nowhere.mgf\n");
    expect_refused([&] { read_scene(gone); }, gone.string() + ":1:3", "no such file");
    folder.write("deep0.mgf", square + "f a b c\n");
    for (int i = 1; i < 40; ++i)
        folder.write("deep" + std::to_string(i) + ".mgf",
                     "i deep" + std::to_string(i - 1) + ".mgf\n");
    EXPECT_EQ(read_scene(folder.path() / "deep31.mgf").polygons.size(), 1U);
    expect_refused([&] { read_scene(folder.path() / "deep39.mgf"); },
                   (folder.path() / "deep8.mgf").string() + ":1:3", "--max-include-depth");
    ReadOptions deeper;
    deeper.max_include_depth = 40;
    EXPECT_EQ(read_scene(folder.path() / "deep39.mgf", deeper).polygons.size(), 1U);
    // Two of the one before, thirty times over.
    for (int i = 1; i < 30; ++i) {
        const std::string before = "i deep" + std::to_string(i - 1) + ".mgf\n";
        folder.write("deep" + std::to_string(i) + ".mgf", before + before);
    }
    EXPECT_NE(
        testing::refusal([&] { read_scene(folder.path() / "deep29.mgf"); }).find("--max-files"),
        std::string::npos);
}

TEST(Mgf, IncludesStayInTheScenesFolder) {
    const Folder folder;
    const auto secret = folder.write("secret.mgf", square + "f a b c\n");
    folder.write("scene/in.mgf", "i " + secret.string() + "\n");
    const auto up = folder.write("scene/up.mgf", "i ../secret.mgf\n");
    const auto absolute = folder.write("scene/absolute.mgf", "i " + secret.string() + "\n");
    const auto indirect = folder.write("scene/indirect.mgf", "i in.mgf\n");
    expect_refused([&] { read_scene(up); }, up.string() + ":1:3", "inside the scene's folder");
    EXPECT_EQ(read_scene(absolute).polygons.size(), 1U);  // the user's own file says so
    expect_refused([&] { read_scene(indirect); },
                   (folder.path() / "scene/in.mgf").string() + ":1:3", "inside the scene's folder");
}

TEST(Mgf, ArraysWithoutEndAreRefusedAtOnce) {
    const auto begin = std::chrono::steady_clock::now();
    expect_refused(
        [&] { parse(square + "xf -a 1000000 -t 1 0 0\nxf -a 1000000 -t 0 1 0\nf a b c\n"); },
        "t.mgf:10:1", "--max-lines");
    expect_refused([&] { parse(square + "xf -a 1e15 -t 1 0 0\n"); }, "t.mgf:9:1", "--max-lines");
    expect_refused([&] { parse(square + "xf -a 1000000 -t 1 0 0\nsph a 1\n"); }, "t.mgf:10",
                   "--max-polygons");
    // An array of a file with an array of a file with an array …
    const Folder folder;
    folder.write("a0.mgf", square + "f a b c\n");
    for (int i = 1; i < 10; ++i)
        folder.write("a" + std::to_string(i) + ".mgf",
                     "i a" + std::to_string(i - 1) + ".mgf -a 1000 -t 1 0 0\n");
    EXPECT_NE(testing::refusal([&] { read_scene(folder.path() / "a9.mgf"); }).find("--max-"),
              std::string::npos);
    ReadOptions few;
    few.max_polygons = 10;
    expect_refused([&] { parse(square + "xf -a 11 -t 1 0 0\nf a b c\nxf\n", few); }, "t.mgf:10",
                   "more than 10 polygons");
    EXPECT_EQ(parse(square + "xf -a 10 -t 1 0 0\nf a b c\nxf\n", few).polygons.size(), 10U);
    ReadOptions triangle;
    triangle.max_corners = 3;
    expect_refused([&] { parse(square + "f a b c d\n", triangle); }, "t.mgf:9:1", "--max-corners");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(took.count(), 1);
}

TEST(Mgf, WhatBreaksTheRulesIsToldOncePerKind) {
    const Scene scene = parse("/usr/local/lib/scene.mgf\nHello world\nHello again\n" + square +
                              "f a b c\nm grey =\n rd .5 .6\nv e =\n p 1 2 3 4\nxf\no\no open\n" +
                              "p " + std::string(4100, ' ') + "1 1 1\n");
    EXPECT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(place_of_warning(scene, "'/usr/local/lib/scene.mgf' is no entity").text(), "t.mgf:1");
    EXPECT_EQ(place_of_warning(scene, "'Hello' is no entity").line, 2U);
    EXPECT_EQ(warned(scene, "(1 more like it)"), 2U);  // Hello, and stray text
    EXPECT_EQ(place_of_warning(scene, "'.6' after 'rd'").line, 14U);
    EXPECT_EQ(place_of_warning(scene, "none is open").line, 17U);
    EXPECT_EQ(warned(scene, "'o' that ends an object, and none is open"), 1U);
    EXPECT_EQ(warned(scene, "without the 'o' that ends it"), 1U);
    EXPECT_EQ(place_of_warning(scene, "MGF allows 4096").line, 20U);
    EXPECT_EQ(scene.warnings.size(), 7U);
}

TEST(Mgf, BodiesWithoutExtentAreLeftOutAndTold) {
    const Scene scene = parse(square +
                              "v n = a\n n 0 0 1\nsph a 0\ncyl a 1 a\ncone a 0 b 0\n"
                              "ring n 1 1\ntorus n 1 1\nprism a b c 0\nf a b c\n");
    EXPECT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(warned(scene, "without extent is left out"), 6U);
}

TEST(Mgf, ASceneInOnePointIsEmpty) {
    const Scene scene =
        parse("m lamp =\nv a =\np 1 2 3\nv b =\np 1 2 3\nv c =\np 1 2 3\nf a b c\n");
    EXPECT_TRUE(scene.polygons.empty() || scene.bounds().diagonal() == 0);
}

TEST(Mgf, LuminairesAreLamps) {
    // 100 cd straight down in C0, falling to nothing at 90°.
    const Folder folder;
    folder.write("lamp.ies",
                 "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 0\n");
    const auto file = folder.write("t.mgf", square +
                                                "f a b c\nxf -s 2\no lamps\n"
                                                "ies lamp.ies -m 3 -rx 180 -t 1 2 3 -a 2 -t 5 0 0\n"
                                                "o\nxf\nies lamp.ies\n");
    const Scene scene = read_scene(file);
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    ASSERT_EQ(scene.luminaires.size(), 3U);
    const Luminaire& second = scene.luminaires[1];
    EXPECT_EQ(second.name, "lamps[1]");
    expect_vector(second.position, {12, 4, 6});
    expect_vector(second.nadir, {0, 0, 1});
    expect_vector(second.c0, {1, 0, 0});
    EXPECT_EQ(second.place.line, 12U);
    EXPECT_NEAR(second.intensity({0, 0, 1}), 300, 1e-9);
    EXPECT_NEAR(second.intensity({0, 0, -1}), 0, 1e-9);
    EXPECT_NEAR(scene.luminaires[2].intensity({0, 0, -1}), 100, 1e-9);
    EXPECT_EQ(scene.luminaires[2].name, "lamp");
    EXPECT_EQ(scene.luminaires[0].photometry, second.photometry);

    const auto gone = folder.write("gone.mgf", square + "ies nowhere.ies\n");
    expect_refused([&] { read_scene(gone); }, gone.string() + ":9:5", "cannot be read");
    const auto mirrored = folder.write("mirrored.mgf", square + "ies lamp.ies -mx\n");
    EXPECT_EQ(warned(read_scene(mirrored), "is mirrored"), 1U);
    const auto countless = folder.write("many.mgf", square + "ies lamp.ies -a 1e9 -t 1 0 0\n");
    expect_refused([&] { read_scene(countless); }, countless.string() + ":9:1", "--max-lines");
}

TEST(Mgf, BadInputIsRefusedWithItsPlace) {
    const auto refused = [](const std::string& text, const std::string& place,
                            const std::string& words) {
        expect_refused([&] { parse(text); }, "t.mgf:" + place, words);
    };
    refused("", "1:1", "no entity of MGF");
    refused("nothing\nhere\n", "1:1", "no entity of MGF");
    refused("v a =\n p 0 0\n", "2:7", "the end of the line, expected coordinates");
    refused("v a =\n p 0 zero 0\n", "2:6", "found 'zero', expected a coordinate");
    refused("v a =\n p 0 nan 0\n", "2:6", "found 'nan'");
    refused("v a =\n p 0 1e300 0\n", "2:6", "found '1e300'");
    refused("f a b c\n", "1:3", "no vertex 'a'");
    refused("m grey =\n rd .5\nm gray\n", "3:3", "no material 'gray', did you mean 'grey'?");
    refused("m grey is\n", "1:8", "found 'is', expected '='");
    refused("m a = b\n", "1:7", "no material 'b'");
    refused("c x =\n cxy .5 0\n", "2:9", "y above 0");
    refused("c x =\n cxy .8 .5\n", "2:9", "x + y at most 1");
    refused("c x =\n cspec 400 300 1 1\n", "2:12", "a longer wavelength");
    refused("c x =\n cspec 400 500 1 -1\n", "2:18", "0 or more");
    refused("c x =\n cct -5\n", "2:6", "a temperature");
    refused("c x =\n cmix 1 y\n", "2:9", "no colour 'y'");
    refused("m x =\n rd 1.5\n", "2:5", "a share of light, 0 to 1");
    refused("m x =\n sides 3\n", "2:8", "1 or 2 sides");
    refused("m x =\n rs .5\n", "2:7", "a share of light and a roughness");
    refused("xf -s 0\n", "1:7", "a scale, not zero");
    refused("xf -t 1 2\n", "1:10", "a distance");
    refused("xf -q 1\n", "1:4", "found '-q'");
    refused("xf -a 0\n", "1:7", "at least 1");
    refused("xf -a 2.5\n", "1:7", "a whole number");
    refused(square + "ring a 0 1\n", "9:6", "a vertex with a normal");
    refused(square + "cone a 1 b -1\n", "9:12", "of the same sign");
    refused(square + "torus a 2 1\n", "9:11", "a larger outer radius");
}

TEST(Mgf, StrictTurnsWarningsIntoErrors) {
    const Folder folder;
    const auto file = folder.write("t.mgf", square + "f a b c d\nstray text\nmore text\n");
    EXPECT_EQ(read_scene(file).warnings.size(), 2U);
    ReadOptions strict;
    strict.strict = true;
    expect_refused(
        [&] { read_scene(file, strict); }, file.string() + ":10",
        "'stray' is no entity of MGF; the line is skipped (--strict; 2 warnings in all)");
    EXPECT_EQ(read_scene(folder.write("good.mgf", square + "f a b c d\n"), strict).polygons.size(),
              1U);
}

TEST(Mgf, FilesHaveALargestSize) {
    const Folder folder;
    const auto file = folder.write("t.mgf", square + "f a b c d\n");
    ReadOptions small;
    small.max_file_size = 1e-5;  // ten bytes
    expect_refused([&] { read_scene(file, small); }, file.string(), "--max-file-size");
}

// Counts of the real files are checked by test_mgf_counts.py, against a reader of its own.
TEST(Mgf, RealFilesOpen) {
    const auto cube = beside_project("mgf/cube.mgf"), corridor = beside_project("mgf/corridor.mgf"),
               examp1 = beside_project("mgf/examp1.mgf"), soda = beside_project("mgf/soda.mgf");
    if (!cube || !corridor || !examp1 || !soda) GTEST_SKIP() << "../shared/scenes/mgf is not there";
    for (const auto& file : {*cube, *corridor, *examp1, *soda}) {
        const Scene scene = read_scene(file);
        EXPECT_EQ(scene.quantity, Quantity::photometric) << file;
        for (const Material& m : scene.materials)
            for (std::size_t b = 0; b < 3; ++b) {
                const auto band = [&](const Spectrum& s) { return s.empty() ? 0 : s[b]; };
                EXPECT_LE(m.reflectance[b] + band(m.specular) + band(m.transmittance) +
                              band(m.diffuse_transmittance),
                          1 + 1e-9)
                    << m.name;
            }
    }
    // A two-sided panel of 1 m² at 200 000 lm/m²; rd .9 + rs .2 is too much.
    const Scene box = read_scene(*cube);
    EXPECT_EQ(warned(box, "of material 'geel' is 1.1"), 1U);
    EXPECT_EQ(box.materials.size(), 9U);
    // Five spheres of 8 inches: no light is sent into them.
    const Scene shop = read_scene(*soda);
    EXPECT_EQ(warned(shop, "'big_200w_incandescent' is two-sided and would emit into closed"), 1U);
    double flux = 0;
    for (const Polygon& polygon : shop.polygons)
        flux += shop.area(polygon) * luminance(shop.material(polygon).exitance);
    EXPECT_NEAR(flux, 626.5 * 5 * 4 * pi * std::pow(8 * 0.0254, 2), 0.2);
    // The glass is clear, and the brass was defined twice.
    EXPECT_NEAR(luminance(material(shop, "normal_glass").transmittance), 0.94, 1e-9);
    EXPECT_EQ(warned(shop, "'polished_brass' is defined again"), 1U);
    // Two lamps of 48 inches by 1 inch.
    const Scene fixture = read_scene(*examp1);
    flux = 0;
    for (const Polygon& polygon : fixture.polygons)
        flux += fixture.area(polygon) * luminance(fixture.material(polygon).exitance);
    EXPECT_NEAR(flux, 44700 * 2 * pi * 0.0254 * 48 * 0.0254, 1);
}

}  // namespace
}  // namespace exitance
