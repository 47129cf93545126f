// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/rad.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numbers>

#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;

constexpr double pi = std::numbers::pi;

const std::string white = "void plastic white 0 0 5 .5 .5 .5 0 0\n";
const std::string square = "white polygon floor 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n";

Scene parse(const std::string& text, const ReadOptions& options = {}) {
    return parse_rad("t.rad", text, options);
}

std::size_t warned(const Scene& scene, const std::string& words) {
    return static_cast<std::size_t>(std::count_if(
        scene.warnings.begin(), scene.warnings.end(),
        [&](const Problem& problem) { return problem.what.find(words) != std::string::npos; }));
}

double total_area(const Scene& scene) {
    double sum = 0;
    for (const Polygon& polygon : scene.polygons) sum += scene.area(polygon);
    return sum;
}

void expect_vector(const Vec3& v, const Vec3& expected) {
    EXPECT_NEAR(v.x, expected.x, 1e-12);
    EXPECT_NEAR(v.y, expected.y, 1e-12);
    EXPECT_NEAR(v.z, expected.z, 1e-12);
}

void expect_bands(const Spectrum& s, double r, double g, double b) {
    ASSERT_EQ(s.size(), 3U);
    EXPECT_NEAR(s[0], r, 1e-9);
    EXPECT_NEAR(s[1], g, 1e-9);
    EXPECT_NEAR(s[2], b, 1e-9);
}

// The material of a polygon that has it.
Material material(const std::string& type_and_arguments) {
    const Scene scene =
        parse("void " + type_and_arguments + "\nm polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n");
    EXPECT_EQ(scene.materials.size(), 1U);
    return scene.materials.at(0);
}

// Least and most of how polygons face away from the middle: both positive = all fronts outside.
std::pair<double, double> outward(const Scene& scene) {
    const Vec3 middle = scene.bounds().centre();
    double least = 1e9, most = -1e9;
    for (const Polygon& polygon : scene.polygons) {
        const auto c = scene.corners(polygon);
        const double along = dot(scene.normal(polygon), (c[0] + c[1] + c[2]) / 3.0 - middle);
        least = std::min(least, along);
        most = std::max(most, along);
    }
    return {least, most};
}

TEST(Rad, ASquare) {
    const Scene scene = parse("# comment\n" + white +
                              "\nwhite\tpolygon floor.12\n0\n0\n12\n 0 0 0\n"
                              " 1 0 0 # here too\n 1 1 0\n 0 1 0\n");
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(scene.polygons[0].line, 4U);
    expect_vector(scene.normal(scene.polygons[0]), {0, 0, 1});
    EXPECT_EQ(scene.surfaces[0].name, "floor");
    EXPECT_EQ(scene.materials[0].name, "white");
    EXPECT_TRUE(scene.materials[0].two_sided);
    EXPECT_EQ(scene.quantity, Quantity::unitless);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Rad, Materials) {
    const Material plastic = material("plastic m 0 0 5 .8 .4 .2 .05 .1");
    expect_bands(plastic.reflectance, 0.76, 0.38, 0.19);  // what is not mirrored, in colour
    expect_bands(plastic.specular, 0.05, 0.05, 0.05);
    EXPECT_EQ(plastic.roughness, 0.1);
    const Material metal = material("metal m 0 0 5 .8 .4 .2 .9 0");
    expect_bands(metal.reflectance, 0.08, 0.04, 0.02);
    expect_bands(metal.specular, 0.72, 0.36, 0.18);
    const Material trans = material("trans m 0 0 7 1 .5 .25 .2 0 .5 .25");
    expect_bands(trans.specular, 0.2, 0.2, 0.2);
    expect_bands(trans.reflectance, 0.4, 0.2, 0.1);               // 0.8 · 0.5
    expect_bands(trans.diffuse_transmittance, 0.3, 0.15, 0.075);  // 0.8 · 0.5 · 0.75
    expect_bands(trans.transmittance, 0.1, 0.05, 0.025);
    const Material mirror = material("mirror m 0 0 3 .9 .8 .7");
    expect_bands(mirror.specular, 0.9, 0.8, 0.7);
    expect_bands(mirror.reflectance, 0, 0, 0);
    const Material anisotropic = material("metal2 m 4 ux uy uz . 0 6 .8 .4 .2 .9 .1 .4");
    EXPECT_NEAR(anisotropic.roughness, 0.2, 1e-12);
    expect_bands(material("trans2 m 4 ux uy uz . 0 8 1 1 1 0 0 0 .5 1").transmittance, 0.5, 0.5,
                 0.5);
}

TEST(Rad, GlassTransmitsWhatItsTransmissivitySays) {
    // The format's own fit of transmissivity to transmittance, for n = 1.52.
    const double wanted = 0.88;
    const double t = (std::sqrt(0.8402528435 + 0.0072522239 * wanted * wanted) - 0.9166530661) /
                     0.0036261119 / wanted;
    for (const double through : material(fmt::format("glass m 0 0 3 {0} {0} {0}", t)).transmittance)
        EXPECT_NEAR(through, wanted, 1e-6);
    const Material glass = material("glass m 0 0 3 .96 .96 .96");
    const double r = std::pow(0.52 / 2.52, 2);
    EXPECT_NEAR(glass.specular[0],
                r + (1 - r) * (1 - r) * r * 0.96 * 0.96 / (1 - r * r * 0.96 * 0.96), 1e-12);
    EXPECT_EQ(glass.refractive_index, 1.52);
    // Index 1: nothing is mirrored.
    const Material film = material("glass m 0 0 4 .5 .6 .7 1");
    expect_bands(film.transmittance, 0.5, 0.6, 0.7);
    const Material diamond = material("dielectric m 0 0 5 1 1 1 2.4 0");
    EXPECT_NEAR(diamond.specular[1], std::pow(1.4 / 3.4, 2), 1e-12);
    EXPECT_NEAR(diamond.specular[1] + diamond.transmittance[1], 1, 1e-12);
}

TEST(Rad, LampsEmitPiTimesTheirRadianceFromTheirFront) {
    for (const char* type :
         {"light m 0 0 3 1 2 3", "glow m 0 0 4 1 2 3 0", "illum m 0 0 3 1 2 3"}) {
        const Material lamp = material(type);
        expect_bands(lamp.exitance, pi, 2 * pi, 3 * pi);
        EXPECT_FALSE(lamp.two_sided);
        expect_bands(lamp.reflectance, 0, 0, 0);
    }
    // A cone of 60° in all: π sin² 30°.
    expect_bands(material("spotlight m 0 0 7 4 4 4 60 0 0 -1").exitance, pi, pi, pi);
    const Scene scene = parse("void light m 0 0 3 1 1 1\nm sphere s 0 0 4 0 0 0 1\n");
    EXPECT_EQ(scene.quantity, Quantity::radiometric);
    double flux = 0;
    for (const Polygon& polygon : scene.polygons)
        flux += scene.area(polygon) * luminance(scene.material(polygon).exitance);
    EXPECT_NEAR(flux, pi * 4 * pi, pi * 4 * pi * 5e-5);  // of the true sphere, factor to 1e-4
}

TEST(Rad, SourcesAreDiscsAtInfinity) {
    const Scene scene =
        parse("void light solar 0 0 3 6e6 6e6 3e6\nsolar source sun 0 0 4 0 3 4 .5\n");
    EXPECT_EQ(scene.quantity, Quantity::radiometric);
    ASSERT_EQ(scene.distant.size(), 1U);
    const DistantLight& sun = scene.distant[0];
    EXPECT_EQ(sun.name, "sun");
    EXPECT_NEAR(length(sun.direction - Vec3{0, 0.6, 0.8}), 0, 1e-12);
    EXPECT_NEAR(sun.diameter, 0.5 * pi / 180, 1e-12);
    const double sine = std::sin(0.25 * pi / 180);
    EXPECT_NEAR(sun.irradiance * sun.colour[0], 6e6 * pi * sine * sine, 1e-8);
    EXPECT_NEAR(sun.irradiance * sun.colour[2], 3e6 * pi * sine * sine, 1e-8);
    expect_refused([] { parse("void light m 0 0 3 1 1 1\nm source s 0 0 4 0 0 0 1\n"); }, "t.rad:2",
                   "direction");
}

TEST(Rad, TypesThatAreTakenAsSomethingElseAreTold) {
    const Scene scene = parse(
        "void colorpict stripes 7 red green blue s.hdr . u v 0 0\n"
        "stripes plasfunc cloth 2 f cloth.cal 0 4 .6 .5 .4 .1\n"
        "void BSDF blind 6 0 blind.xml 0 0 1 . 0 9 .3 .3 .3 .2 .2 .2 .1 .1 .1\n"
        "void mixfunc both 4 cloth void f f.cal 0 0\n"
        "cloth polygon p 0 0 9 0 0 0 1 0 0 1 1 0\nblind polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n"
        "both polygon p 0 0 9 0 0 1 1 0 1 1 1 1\nstripes polygon p 0 0 9 0 0 1 1 0 1 1 1 1\n"
        "void mist fog 0 0 0\nfog sphere s 0 0 4 0 0 0 1\n"
        "void glow blue 0 0 4 1 1 2 0\nblue source sky 0 0 4 0 0 1 180\nvoid instance chair 1 "
        "chair.oct 0 0\n");
    EXPECT_EQ(scene.polygons.size(), 4U);
    expect_bands(scene.material(scene.polygons[0]).reflectance, 0.54, 0.45, 0.36);
    expect_bands(scene.material(scene.polygons[1]).diffuse_transmittance, 0.1, 0.1, 0.1);
    EXPECT_EQ(scene.material(scene.polygons[2]).name, "cloth");
    EXPECT_EQ(scene.material(scene.polygons[3]).name, "void");
    for (const char* words :
         {"colorpict 'stripes' is not applied", "mixfunc 'both' is not applied", "of type plasfunc",
          "of type BSDF", "of type mist", "source 'sky'", "instance 'chair'",
          "no surface (antimatter or mist)", "without material is black"})
        EXPECT_EQ(warned(scene, words), 1U) << words;
}

TEST(Rad, ModifiersAreTheLastOfTheirName) {
    const Scene scene =
        parse(white + square + "void plastic white 0 0 5 .9 .9 .9 0 0\n" + square +
              "void alias paint white\npaint polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n" + white + square);
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].name, "white (2)");
    expect_bands(scene.material(scene.polygons[0]).reflectance, 0.5, 0.5, 0.5);
    expect_bands(scene.material(scene.polygons[1]).reflectance, 0.9, 0.9, 0.9);
    expect_bands(scene.material(scene.polygons[2]).reflectance, 0.9, 0.9, 0.9);
    expect_bands(scene.material(scene.polygons[3]).reflectance, 0.5, 0.5, 0.5);
}

TEST(Rad, CurvedSurfaces) {
    // 16 facets a turn; the areas are those of curved_primitives_test.cpp.
    const auto of = [](const std::string& surface) { return parse(white + "white " + surface); };
    EXPECT_EQ(of("sphere s 0 0 4 1 2 3 1\n").polygons.size(), 128U);
    EXPECT_GT(outward(of("sphere s 0 0 4 1 2 3 1\n")).first, 0);
    EXPECT_LT(outward(of("bubble s 0 0 4 1 2 3 1\n")).second, 0);
    EXPECT_NEAR(total_area(of("cylinder s 0 0 7 0 0 0 0 0 2 .5\n")), 16 * 2 * std::sin(pi / 16),
                1e-12);
    EXPECT_GT(outward(of("cylinder s 0 0 7 0 0 0 0 0 2 .5\n")).first, 0);
    EXPECT_LT(outward(of("tube s 0 0 7 0 0 0 0 0 2 .5\n")).second, 0);
    EXPECT_NEAR(total_area(of("cone s 0 0 8 0 0 0 0 0 2 1 0\n")),
                16 * std::sin(pi / 16) * std::hypot(2, std::cos(pi / 16)), 1e-12);
    EXPECT_LT(outward(of("cup s 0 0 8 0 0 0 0 0 2 1 0\n")).second, 0);
    const Scene ring = of("ring s 0 0 8 1 1 1 0 0 -3 1 2\n");
    EXPECT_NEAR(total_area(ring), 8 * std::sin(pi / 8) * 3, 1e-12);
    for (const Polygon& polygon : ring.polygons) expect_vector(ring.normal(polygon), {0, 0, -1});
    EXPECT_EQ(warned(of("cylinder s 0 0 7 0 0 0 0 0 0 .5\n"), "without extent"), 1U);
}

TEST(Rad, HolesBySeams) {
    const Scene scene = parse(white +
                              "white polygon wall 0 0 30 0 0 0 4 0 0 4 3 0 0 3 0 0 0 0\n"
                              "1 1 0 1 2 0 3 2 0 3 1 0 1 1 0\n");
    EXPECT_NEAR(total_area(scene), 10, 1e-12);
}

TEST(Rad, Genbox) {
    const Scene box = parse(white + "!genbox white box 1 2 3\n");
    ASSERT_EQ(box.polygons.size(), 6U);
    EXPECT_NEAR(total_area(box), 2 * (2 + 3 + 6), 1e-12);
    EXPECT_EQ(box.bounds().upper, (Vec3{1, 2, 3}));
    EXPECT_GT(outward(box).first, 0);
    EXPECT_EQ(box.surfaces[0].name, "box");
    EXPECT_LT(outward(parse(white + "!genbox white box 1 2 3 -i\n")).second, 0);
    const Scene bevelled = parse(white + "!genbox white box 1 2 3 -b .1\n");
    EXPECT_EQ(bevelled.polygons.size(), 6U);
    EXPECT_EQ(warned(bevelled, "genbox -b"), 1U);
}

TEST(Rad, Genprism) {
    // Clockwise seen from +z and raised to +z: all fronts outside.
    const Scene prism = parse(white + "!genprism white p 4 0 0 0 1 2 1 2 0 -l 0 0 3\n");
    ASSERT_EQ(prism.polygons.size(), 6U);
    EXPECT_NEAR(total_area(prism), 2 * 2 + 3 * 6, 1e-12);
    EXPECT_GT(outward(prism).first, 0);
    EXPECT_EQ(parse(white + "!genprism white p 3 0 0 .5 1 1 0 -e\n").polygons.size(), 3U);
    EXPECT_EQ(parse(white + "!genprism white p 3 0 0 .5 1 1 0 -c\n").polygons.size(), 4U);
    EXPECT_EQ(parse(white + "!genprism white p 3 0 0 .5 1 1 0 -c -e\n").bounds().upper.z, 1);
}

TEST(Rad, XformOfFiles) {
    const Folder folder;
    folder.write("parts/leg.rad", "white polygon leg.1 0 0 9 0 0 0 1 0 0 0 1 0\n");
    folder.write("parts/chair.rad", white + "!xform -n left -t 0 0 1 leg.rad\n");
    const auto file = folder.write(
        "room.rad", "!xform -n chair -rz 90 -a 2 -t 5 0 0 -i 1 -s 2 \\\n parts/chair.rad\n");
    const Scene scene = read_scene(file);
    ASSERT_EQ(scene.polygons.size(), 2U);
    EXPECT_EQ(scene.surfaces[scene.polygons[1].surface].name, "chair[1]/left/leg");
    EXPECT_EQ(scene.materials.size(), 1U);  // defined again by every copy
    // Up 1, turned, moved by 5, doubled.
    expect_vector(scene.points[scene.polygons[1].corners[0]], {10, 0, 2});
    expect_vector(scene.points[scene.polygons[1].corners[1]], {10, 2, 2});
}

TEST(Rad, XformOfPipesModifiersAndInversion) {
    const Scene scene = parse(white +
                              "void plastic red 0 0 5 .9 .1 .1 0 0\n"
                              "!genbox white b 1 1 1 | xform -m red -I | xform -t 1 2 3\n"
                              "!genbox white b 1 1 1 | xform -mx\n");
    ASSERT_EQ(scene.polygons.size(), 12U);
    EXPECT_EQ(scene.material(scene.polygons[0]).name, "red");
    EXPECT_EQ(scene.material(scene.polygons[6]).name, "white");
    Scene first = scene, second = scene;
    first.polygons.resize(6);
    second.polygons.erase(second.polygons.begin(), second.polygons.begin() + 6);
    EXPECT_EQ(first.bounds().lower, (Vec3{1, 2, 3}));
    EXPECT_LT(outward(first).second, 0);
    EXPECT_EQ(second.bounds().lower, (Vec3{-1, 0, 0}));
    EXPECT_GT(outward(second).first, 0);
}

TEST(Rad, NoCommandIsExecuted) {
    const Folder folder;
    const auto mark = folder.path() / "mark";
    for (const std::string& command : std::vector<std::string>{
             "touch " + mark.string(), "sh -c 'touch " + mark.string() + "'",
             "genbox white b 1 1 1; touch " + mark.string(),
             "genbox white b 1 1 1 | tee " + mark.string(), "genbox white `touch x` 1 1 1",
             "genbox white b 1 1 1 > " + mark.string(), "xform $(touch x)", "gensky 6 21 12",
             "cat a", "genbox white 'b 1 1 1", ""}) {
        const std::string message = testing::refusal([&] { parse(white + "!" + command + "\n"); });
        EXPECT_EQ(message.rfind("t.rad:2:1: ", 0), 0U) << message;
        EXPECT_NE(message.find("expected xform, genbox or genprism") != std::string::npos ||
                      message.find("nothing is executed") != std::string::npos ||
                      message.find("quote that does not end") != std::string::npos,
                  false)
            << message;
    }
    EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST(Rad, FilesAndArraysComeToAnEnd) {
    const auto begin = std::chrono::steady_clock::now();
    const Folder folder;
    const auto self = folder.write("self.rad", "!xform -t 1 0 0 self.rad\n");
    expect_refused([&] { read_scene(self); }, self.string() + ":1:1", "includes itself");
    const auto gone = folder.write("gone.rad", "!xform nowhere.rad\n");
    expect_refused([&] { read_scene(gone); }, gone.string() + ":1:1", "no such file");
    const auto out = folder.write("in/out.rad", "!xform ../gone.rad\n");
    expect_refused([&] { read_scene(out); }, out.string() + ":1:1", "inside the scene's folder");
    expect_refused([&] { parse(white + "!genbox white b 1 1 1 | xform -a 1e9 -t 1 0 0\n"); },
                   "t.rad:2:1", "--max-lines");
    expect_refused(
        [&] {
            parse(white +
                  "!genbox white b 1 1 1 | xform -a 1e4 -t 1 0 0 | xform -a 1e4 -t 0 1 0\n");
        },
        "t.rad:2:1", "--max-lines");
    // Arrays in one command, and an array of a file with arrays of a file with arrays …
    expect_refused(
        [&] { parse(white + "!genbox white b 1 1 1 | xform -a 1e5 -t 1 0 0 -i 1 -a 1e5\n"); },
        "t.rad:2:1", "--max-lines");
    folder.write("a0.rad", white + square);
    for (int i = 1; i < 10; ++i)
        folder.write("a" + std::to_string(i) + ".rad",
                     "!xform -a 1000 -t 1 0 0 a" + std::to_string(i - 1) + ".rad\n");
    EXPECT_NE(testing::refusal([&] { read_scene(folder.path() / "a9.rad"); }).find("--max-"),
              std::string::npos);
    ReadOptions long_winded;
    long_winded.max_lines = 1'000'000'000;
    expect_refused(
        [&] { parse(white + "!genbox white b 1 1 1 | xform -a 1e7 -t 1 0 0\n", long_winded); },
        "t.rad:2", "--max-polygons");
    ReadOptions few;
    few.max_polygons = 6;
    EXPECT_EQ(parse(white + "!genbox white b 1 1 1\n", few).polygons.size(), 6U);
    expect_refused([&] { parse(white + "!genbox white b 1 1 1\n" + square, few); }, "t.rad:3",
                   "more than 6 polygons");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(took.count(), 1);
}

TEST(Rad, BadInputIsRefusedWithItsPlace) {
    const auto refused = [](const std::string& text, const std::string& place,
                            const std::string& words) {
        expect_refused([&] { parse(text); }, "t.rad:" + place, words);
    };
    refused("void plastik white 0 0 5\n", "1:6", "did you mean 'plastic'?");
    refused("void plastic white 0 0 5 1 1\n", "2:1",
            "the end of the file, expected a real argument");
    refused("void plastic white 0 0 4 1 1 1 1\n", "1", "found 4 real arguments of 'plastic'");
    refused("void plastic white 0 0 5 2 1 1 1 0\n", "1", "found 2 as real argument 1");
    refused("void plastic white 0 0 5 x 1 1 1 0\n", "1:26", "found 'x', expected a number");
    refused("void plastic white -1\n", "1:20", "a number of words");
    refused("void plastic white 0 0 99999999\n", "2:1", "a real argument");
    refused("white polygon p 0 0 9 0 0 0 1 0 0 1 1 0\n", "1", "no modifier 'white'");
    refused(white + "white polygon p 0 0 8 0 0 0 1 0 0 1 1\n", "2", "three for each");
    refused(white + "white sphere p 0 0 3 0 0 0\n", "2", "found 3 real arguments of sphere");
    refused(white + "white cylinder p 0 0 7 0 0 0 0 0 1 -1\n", "2", "radius -1");
    refused(white + "!genbox white b 1 0 1\n", "2:1", "above 0");
    refused(white + "!genbox white b 1 1 1 -q\n", "2:1", "found '-q'");
    refused(white + "!genprism white b 2 1 1 1 1\n", "2:1", "3 or more");
    refused(white + "!genprism white b 1e9 1 1 1 1\n", "2:1", "the x of a corner");
    refused(white + "!xform -f x\n", "2:1", "found '-f'");
    refused(white + "!xform -t 1 2 3\n", "2:1", "the name of a file");
}

}  // namespace
}  // namespace exitance
