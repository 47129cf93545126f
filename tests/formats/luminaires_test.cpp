// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/luminaires.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/scene/colour_temperature.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;

constexpr double pi = std::numbers::pi;

// 100 cd/klm below C0 … C90 grows to 200 towards C180; 2000 lm, 1.2 m × 0.2 m × 0.1 m.
std::string ldt() {
    std::string out = "Works\n3\n2\n4\n90\n3\n45\n\nA lamp\nW-1\n\n\n1200\n200\n100\n1100\n150\n";
    out += "0\n0\n0\n0\n100\n100\n1\n0\n1\n1\nLED\n2000\n4000\n80\n25\n";
    for (int i = 0; i < 10; ++i) out += "0.5\n";
    out += "0\n90\n180\n270\n0\n45\n90\n";
    for (int i = 0; i < 3; ++i) out += fmt::format("100\n{}\n0\n", 100 + 50 * i);
    return out;
}

struct Project {
    Folder folder;

    Project() { folder.write("lamp.ldt", ldt()); }
    Scene read(const std::string& luminaire, const std::string& rest = "") const {
        return read_scene(folder.write("p.toml", rest + "[[luminaire]]\nname = \"L\"\n" +
                                                     "position = [1, 3, 2]\n" + luminaire));
    }
    Luminaire one(const std::string& luminaire) const {
        Scene scene = read(luminaire);
        EXPECT_EQ(scene.luminaires.size(), 1U);
        EXPECT_TRUE(scene.polygons.empty()) << "no housing unless asked for";
        return scene.luminaires.at(0);
    }
};

void expect_near(const Vec3& found, const Vec3& expected) {
    EXPECT_NEAR(length(found - expected), 0, 1e-9) << found.x << " " << found.y << " " << found.z;
}

TEST(ProjectLuminaires, AFileHangsWithC0AlongX) {
    const Project project;
    const Scene scene = project.read("file = \"lamp.ldt\"");
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    const Luminaire& l = scene.luminaires.at(0);
    expect_near(l.position, {1, 3, 2});
    expect_near(l.nadir, {0, -1, 0});
    expect_near(l.c0, {1, 0, 0});
    expect_near(l.to_world({0, 1, 0}), {0, 0, -1});
    EXPECT_EQ(l.multiplier, 1);
    EXPECT_EQ(l.group, "L");
    EXPECT_NEAR(l.intensity({0, -1, 0}), 200, 1e-9);
}

TEST(ProjectLuminaires, AimTargetAndRotation) {
    const Project project;
    const std::string file = "file = \"lamp.ldt\"\n";
    expect_near(project.one(file + "rotation = 90").c0, {0, 0, -1});
    // Tilted up to +z about x: C0 stays along x.
    const Luminaire tilted = project.one(file + "aim = [0, 0, 2]");
    expect_near(tilted.nadir, {0, 0, 1});
    expect_near(tilted.c0, {1, 0, 0});
    const Luminaire side = project.one(file + "target = [5, 3, 2]");
    expect_near(side.nadir, {1, 0, 0});
    expect_near(side.c0, {0, 1, 0});
    const Luminaire up = project.one(file + "aim = [0, 1, 0]");
    expect_near(up.nadir, {0, 1, 0});
    EXPECT_NEAR(dot(up.c0, up.nadir), 0, 1e-12);
    EXPECT_NEAR(up.intensity({0, 1, 0}), 200, 1e-9);
}

TEST(ProjectLuminaires, FactorsAndOverridesMultiply) {
    const Project project;
    const std::string file = "file = \"lamp.ldt\"\n";
    const double flux = project.one(file).flux();
    EXPECT_NEAR(project.one(file + "multiplier = 2\ndimming = 0.5\nmaintenance = 0.8").flux(),
                0.8 * flux, 1e-9);
    EXPECT_NEAR(project.one(file + "lumens = 1234").flux(), 1234, 1e-9);
    EXPECT_NEAR(project.one(file + "lamp_lumens = 3000").flux(), 1.5 * flux, 1e-9);
    EXPECT_NEAR(project.one(file + "lumens = 1000\nmaintenance = 0.67").flux(), 670, 1e-9);
}

TEST(ProjectLuminaires, ColoursHaveLuminanceOne) {
    const Project project;
    const std::string file = "file = \"lamp.ldt\"\n";
    EXPECT_EQ(project.one(file + "color_temperature = 3000").colour, colour_of_temperature(3000));
    const Luminaire red = project.one(file + "color = [2, 0, 0]");
    EXPECT_NEAR(red.colour[0], 1 / 0.2126, 1e-9);
    EXPECT_EQ(red.colour[1], 0);
    // Lamps with polygons too.
    const Scene panel = project.read(
        "shape = \"disc\"\nradius = 0.1\naim = [0, -1, 0]\nlumens = 500\ndimming = 0.5\n"
        "color_temperature = 3000");
    double sum = 0;
    for (const Polygon& p : panel.polygons)
        sum += panel.area(p) * luminance(panel.material(p).exitance);
    EXPECT_NEAR(sum, 250, 1e-9);
}

TEST(ProjectLuminaires, PointsAndSpots) {
    const Project project;
    const Luminaire point = project.one("shape = \"point\"\nlumens = 1000");
    EXPECT_NEAR(point.flux(), 1000, 1e-9);
    EXPECT_NEAR(point.intensity({0.6, 0.8, 0}), 1000 / (4 * pi), 1e-9);
    EXPECT_NEAR(project.one("shape = \"point\"\ncandela = 50").flux(), 200 * pi, 1e-9);
    const Luminaire spot =
        project.one("shape = \"spot\"\nbeam = 20\nfield = 30\ncandela = 5000\naim = [1, 0, 0]");
    EXPECT_NEAR(spot.intensity({1, 0, 0}), 5000, 1e-9);
    EXPECT_NEAR(spot.intensity({std::cos(pi / 18), 0, std::sin(pi / 18)}), 2500, 2);
    EXPECT_NEAR(spot.intensity({std::cos(pi / 12), std::sin(pi / 12), 0}), 500, 2);
    const Scene watts = project.read("shape = \"point\"\nwatts = 30");
    EXPECT_EQ(watts.quantity, Quantity::radiometric);
    EXPECT_NEAR(watts.luminaires[0].flux(), 30, 1e-9);
}

TEST(ProjectLuminaires, ArraysStandAroundTheirPosition) {
    const Project project;
    const Scene scene =
        project.read("file = \"lamp.ldt\"\ncolumns = 3\nrows = 2\nspacing = [2, 1.5]");
    ASSERT_EQ(scene.luminaires.size(), 6U);
    expect_near(scene.luminaires[0].position, {-1, 3, 1.25});
    expect_near(scene.luminaires[2].position, {3, 3, 1.25});
    expect_near(scene.luminaires[5].position, {3, 3, 2.75});
    EXPECT_EQ(scene.luminaires[5].name, "L 6");
    EXPECT_EQ(scene.luminaires[0].photometry, scene.luminaires[5].photometry) << "read once";
    const LightGroups groups = make_groups(scene, Grouping::file);
    ASSERT_EQ(groups.groups.size(), 1U) << "an array is one group";
    EXPECT_EQ(make_groups(scene, Grouping::luminaire).groups.size(), 6U);
    const Scene turned = project.read(
        "shape = \"point\"\nlumens = 1\ncolumns = 2\nspacing = [2, 0]\narray_rotation = 90");
    expect_near(turned.luminaires[0].position, {1, 3, 3});
    expect_near(turned.luminaires[1].position, {1, 3, 1});
    const Scene panels =
        project.read("shape = \"sphere\"\nradius = 0.1\nlumens = 10\nrows = 2\nspacing = [0, 2]");
    EXPECT_EQ(panels.surfaces.size(), 2U);
    EXPECT_EQ(panels.materials[1].group, "L");
}

TEST(ProjectLuminaires, AHousingStandsOnTheOpening) {
    const Project project;
    const Scene scene = project.read("file = \"lamp.ldt\"\nhousing = true");
    ASSERT_EQ(scene.polygons.size(), 6U);
    const Box box = scene.bounds();
    // The file's length of 1.2 m lies along C90, which is −z; the opening is at its bottom.
    expect_near(box.lower, {0.9, 3, 1.4});
    expect_near(box.upper, {1.1, 3.1, 2.6});
    for (const Polygon& p : scene.polygons)
        EXPECT_GT(dot(scene.normal(p), scene.corners(p)[0] - Vec3(1, 3.05, 2)), 0);
    const Luminaire& l = scene.luminaires.at(0);
    const auto shining = facets(l.photometry->opening);
    ASSERT_EQ(shining.size(), 2U) << "bottom and top, as high as the housing";
    for (const OpeningFacet& f : shining) {
        const double y = (l.position + l.to_world(f.corners[0])).y;
        EXPECT_NEAR(y, f.normal.z < 0 ? 3 : 3.1, 1e-9);
    }
}

TEST(ProjectLuminaires, TiltFactorsFollowTheAim) {
    const Project project;
    project.folder.write("tilt.ies",
                         "IESNA91\nTILT=INCLUDE\n1\n2\n0 90\n1 0.5\n1 1000 1 2 1 1 2 0 0 0\n1 1 9\n"
                         "0 90\n0\n100 100\n");
    EXPECT_EQ(project.one("file = \"tilt.ies\"").multiplier, 1);
    EXPECT_NEAR(project.one("file = \"tilt.ies\"\naim = [1, -1, 0]").multiplier, 0.75, 1e-9);
}

TEST(ProjectLuminaires, AnotherProjectBringsItsLampsAlong) {
    const Project project;
    project.read("file = \"lamp.ldt\"");
    std::filesystem::rename(project.folder.path() / "p.toml", project.folder.path() / "in.toml");
    const auto outer = project.folder.write(
        "out.toml",
        "[[geometry]]\nfile = \"in.toml\"\nrotate = [0, 1, 0, 90]\ntranslate = [0, 1, 0]\n");
    const Scene scene = read_scene(outer);
    expect_near(scene.luminaires.at(0).position, {2, 4, -1});
    expect_near(scene.luminaires[0].c0, {0, 0, -1});
    expect_near(scene.luminaires[0].nadir, {0, -1, 0});
}

TEST(ProjectLuminaires, ArraysWithoutEndAreRefusedAtOnce) {
    const Folder folder;
    const auto spheres = [](int columns, int rows, int tables) {
        std::string out;
        for (int i = 0; i < tables; ++i)
            out += fmt::format(
                "[[luminaire]]\nname = \"{}\"\nshape = \"sphere\"\nradius = 1\n"
                "lumens = 1\nposition = [0, 0, 0]\ncolumns = {}\nrows = {}\n"
                "spacing = [1, 1]\n",
                i, columns, rows);
        return out;
    };
    const auto many = folder.write("many.toml", spheres(200, 300, 2));
    ReadOptions options;
    options.max_luminaires = 119'999;
    options.max_polygons = 1;
    EXPECT_TRUE(testing::quick([&] {
        expect_refused([&] { read_scene(many, options); }, many.string() + ":1:1",
                       "--max-polygons raises the limit");
    }));
    const auto points = folder.write("points.toml", [&] {
        std::string text = spheres(20, 30, 2);
        for (std::size_t at; (at = text.find("\"sphere\"\nradius = 1")) != std::string::npos;)
            text.replace(at, 19, "\"point\"");
        return text;
    }());
    options = {};
    options.max_luminaires = 1199;
    expect_refused([&] { read_scene(points, options); }, points.string() + ":15:8",
                   "1200 lamps, more than 1199; --max-luminaires raises the limit");
    options.max_luminaires = 1200;
    EXPECT_EQ(read_scene(points, options).luminaires.size(), 1200U);
}

TEST(ProjectLuminaires, WhatCanHardlyBeMeantIsAWarning) {
    const Project project;
    const auto warned = [&](const std::string& file, const std::string& words) {
        const Scene scene = project.read("file = \"" + file + "\"");
        ASSERT_EQ(scene.warnings.size(), 1U) << file;
        EXPECT_EQ(scene.warnings[0].place.file, (project.folder.path() / file).string());
        EXPECT_NE(scene.warnings[0].what.find(words), std::string::npos) << scene.warnings[0].what;
    };
    const auto ies = [&](const std::string& name, const std::string& lumens,
                         const std::string& table) {
        project.folder.write(
            name, "IESNA91\nTILT=NONE\n1 " + lumens + " 1 2 1 1 2 0 0 0\n1 1 9\n" + table);
        return name;
    };
    EXPECT_TRUE(
        project.read("file = \"" + ies("a.ies", "400", "0 90\n0\n50 50\n") + "\"").warnings.empty())
        << "2π 50 lm = 314 lm of 400 lm";
    EXPECT_TRUE(project.read("file = \"" + ies("up.ies", "-1", "90 180\n0\n50 50\n") + "\"")
                    .warnings.empty());
    warned(ies("dark.ies", "-1", "0 90\n0\n0 0\n"), "is dark");
    warned(ies("more.ies", "300", "0 90\n0\n50 50\n"), "more than the 300 lm of its lamps");
    warned(ies("short.ies", "-1", "0 80\n0\n50 50\n"), "the angles γ go from 0 to 80°");
    warned(ies("late.ies", "-1", "10 90\n0\n50 50\n"), "the angles γ go from 10 to 90°");
    // What the file of this test sends out is 78.5 % of its lamps; it says 100 %, or 78 %.
    std::string text = ldt();
    const double ratio = project.one("file = \"lamp.ldt\"").flux() / 2000;
    warned("lamp.ldt", "the file states 100.0 %");
    text.replace(text.find("\n100\n100\n1\n"), 11, fmt::format("\n100\n{:.1f}\n1\n", 101 * ratio));
    project.folder.write("stated.ldt", text);
    EXPECT_TRUE(project.read("file = \"stated.ldt\"").warnings.empty());
    for (const std::string lamp :
         {"shape = \"point\"\nlumens = 0", "shape = \"point\"\ncandela = 0",
          "shape = \"disc\"\nradius = 1\naim = [0, -1, 0]\nlumens = 0"}) {
        const Scene dark = project.read(lamp);
        ASSERT_EQ(dark.warnings.size(), 1U) << lamp;
        EXPECT_NE(dark.warnings[0].what.find("found 0: the luminaire is dark"), std::string::npos);
    }
    EXPECT_TRUE(project.read("shape = \"point\"\nlumens = 1\ndimming = 0").warnings.empty())
        << "switched off";
}

TEST(ProjectLuminaires, RefusalsNameThePlace) {
    const Project project;
    const std::string toml = (project.folder.path() / "p.toml").string();
    const auto refused = [&](const std::string& text, const std::string& place,
                             const std::string& words) {
        expect_refused([&] { project.read(text); }, toml + ":" + place, words);
    };
    refused("file = \"gone.ldt\"", "4:8", "there is none at");
    refused("file = \"p.toml\"", "4:8", "expected a photometric file, .ies or .ldt");
    refused("file = \"lamp.ldt\"\nshape = \"point\"", "5:9", "found both 'file' and 'shape'");
    refused("lumens = 5", "1:1", "shape");
    refused("file = \"lamp.ldt\"\nwidth = 1", "5:9", "a luminaire with a file has no 'width'");
    refused("file = \"lamp.ldt\"\nlumen = 1", "5:1", "did you mean 'lumens'");
    refused("file = \"lamp.ldt\"\nlumens = 1\nlamp_lumens = 2", "6:15", "found both 'lumens' and");
    refused("file = \"lamp.ldt\"\ncandela = 1", "5:11", "expected 'lumens' or 'lamp_lumens'");
    expect_refused([&] { project.read("file = \"lamp.ldt\"\nlamp_set = 2"); },
                   (project.folder.path() / "lamp.ldt").string() + ":26:1",
                   "found 1 set of lamps, expected a set 2");
    refused("file = \"lamp.ldt\"\naim = [0, 0, 0]", "5:7", "aim: found the zero vector");
    refused("file = \"lamp.ldt\"\ntarget = [1, 3, 2]", "5:10", "not the lamp's own");
    refused("file = \"lamp.ldt\"\naim = [1, 0, 0]\ntarget = [0, 0, 0]", "6:10", "both 'aim' and");
    refused("file = \"lamp.ldt\"\ndimming = 1.5", "5:11", "dimming");
    refused("file = \"lamp.ldt\"\ncolor_temperature = 300", "5:21", "color_temperature");
    refused("file = \"lamp.ldt\"\ncolumns = 2", "1:1", "spacing");
    refused("file = \"lamp.ldt\"\nspacing = [1, 1]", "5:11", "of a single lamp");
    refused("file = \"lamp.ldt\"\ncolumns = 1000\nrows = 1000\nspacing = [1, 1]", "6:8",
            "1000000 lamps, more than 100000; --max-luminaires raises the limit");
    refused("shape = \"point\"", "1:1", "found none of 'lumens', 'watts' and 'candela'");
    refused("shape = \"point\"\nlumens = 1\naim = [0, 1, 0]", "6:7", "a point has no 'aim'");
    refused("shape = \"spot\"\nlumens = 1", "1:1", "beam");
    refused("shape = \"spot\"\nlumens = 1\nbeam = 20\nfield = 20", "7:9", "wider than 'beam'");
    refused("shape = \"spot\"\nlumens = 1\nbeam = 20\nhousing = true", "7:11", "a spot has no");
    project.folder.write("plain.ies",
                         "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n1 1\n");
    refused("file = \"plain.ies\"\nhousing = true", "5:11",
            "housing: 'plain.ies' does not say how large the luminaire is");
    refused("file = \"plain.ies\"\nlamp_lumens = 5", "5:15", "measured as a whole");
    project.folder.write("bad.ldt", "Works\n3\n9\n");
    expect_refused([&] { project.read("file = \"bad.ldt\""); },
                   (project.folder.path() / "bad.ldt").string() + ":3:1", "the symmetry");
    expect_refused([&] { project.read("file = \"lamp.ldt\"", "quantity = \"radiometric\"\n"); },
                   toml + ":5:8", "'file' is photometric");
}

}  // namespace
}  // namespace exitance
