// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/project.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <numbers>

#include "exitance/math/polygon.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/read.h"
#include "exitance/scene/spectrum.h"
#include "formats/gltf_samples.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;
using testing::Folder;

constexpr double pi = std::numbers::pi;

// Every table and nearly every key.
const std::string everything = R"(title = "Every table"
quantity = "photometric"

[[material]]
name = "paint"
reflectance = [0.7, 0.6, 0.5]

[[material]]
name = "panel"
reflectance = 0
luminance = 100
group = "ceiling"
two_sided = true

[[material]]
match = "pai*"
reflectance = 0.8

[[polygon]]
name = "floor"
material = "paint"
patches = 4
corners = [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]]

[[polygon]]
material = "panel"
corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]

[[luminaire]]
name = "desk lamp"
shape = "disc"
position = [0, 2, 0]
aim = [0, -1, 0]
radius = 0.1
lumens = 800
color = [1, 0.8, 0.6]

[[camera]]
name = "door"
eye = [1, 1.6, 3]
look_at = [0, 1, 0]
up = [0, 1, 0]
fov = 60

[[grid]]
name = "desk"
origin = [0, 0.8, 0]
u = [1, 0, 0]
v = [0, 0, 1]
columns = 10
rows = 5
normal = [0, 1, 0]

[solve]
error = 0.05
solver = "shooting"
merge = false
seed = 7
)";

Scene parse(const std::string& text) {
    return parse_project("t.toml", text,
                         [](const std::filesystem::path&, const Place& at) -> Scene {
                             throw Error(at, "no files here");
                         });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

std::string lamp(const std::string& keys) {
    return "[[luminaire]]\nname = \"lamp\"\nposition = [1, 2, 3]\n" + keys;
}

double flux_of(const Scene& scene) {
    double flux = 0;
    for (const Polygon& polygon : scene.polygons)
        flux += scene.area(polygon) * luminance(scene.material(polygon).exitance);
    return flux;
}

double area_of(const Scene& scene) {
    double area = 0;
    for (const Polygon& polygon : scene.polygons) area += scene.area(polygon);
    return area;
}

TEST(Project, ReadsEveryTable) {
    const Scene scene = parse(everything);
    EXPECT_EQ(scene.title, "Every table");
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(3, 0.8));
    EXPECT_NEAR(scene.materials[1].exitance[0], 100 * pi, 1e-12);
    EXPECT_EQ(scene.materials[1].group, "ceiling");
    EXPECT_TRUE(scene.materials[1].two_sided);
    EXPECT_EQ(scene.surfaces[0].name, "floor");
    EXPECT_EQ(scene.polygons[0].patches, 4U);
    EXPECT_EQ(scene.polygons[0].line, 19U);
    EXPECT_EQ(scene.surfaces[1].name, "panel");
    EXPECT_EQ(scene.polygons[1].patches, 0U);
    EXPECT_EQ(scene.polygons[1].size(), 3U);
    // The corner (1, 0, 0) of both polygons is one point.
    EXPECT_EQ(scene.polygons[0].corners[3], scene.polygons[1].corners[1]);
    EXPECT_EQ(scene.materials[2].name, "desk lamp");
    EXPECT_EQ(scene.materials[2].group, "desk lamp");
    EXPECT_TRUE(scene.surfaces[2].luminaire);
    EXPECT_FALSE(scene.surfaces[0].luminaire);
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].name, "door");
    EXPECT_EQ(scene.cameras[0].eye, (Vec3{1, 1.6, 3}));
    EXPECT_EQ(scene.cameras[0].fov_y, 60);
    ASSERT_EQ(scene.grids.size(), 1U);
    EXPECT_EQ(scene.grids[0].columns, 10U);
    EXPECT_EQ(scene.grids[0].rows, 5U);
    EXPECT_EQ(scene.grids[0].normal, (Vec3{0, 1, 0}));
    std::map<std::string, std::string> settings;
    for (const Setting& setting : scene.settings) settings[setting.name] = setting.value;
    EXPECT_EQ(settings,
              (std::map<std::string, std::string>{
                  {"error", "0.05"}, {"solver", "shooting"}, {"merge", "false"}, {"seed", "7"}}));
    for (const Setting& setting : scene.settings)
        if (setting.name == "solver") {
            EXPECT_EQ(setting.place.text(), "t.toml:56:10");
        }
}

TEST(Project, RectanglesFaceTheirAimAndHaveTheirFlux) {
    const Scene scene = parse(
        lamp("shape = \"rectangle\"\naim = [0, 0, -2]\nup = [0, 3, 3]\nwidth = 0.6\nheight = 0.2\n"
             "lumens = 1200\n"));
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_NEAR(area_of(scene), 0.12, 1e-15);
    EXPECT_LT(length(scene.normal(scene.polygons[0]) - Vec3{0, 0, -1}), 1e-15);
    EXPECT_NEAR(flux_of(scene), 1200, 1e-9);
    const Box box = scene.bounds();  // height along y: up without its part along the aim
    EXPECT_NEAR(box.size().x, 0.6, 1e-15);
    EXPECT_NEAR(box.size().y, 0.2, 1e-15);
    EXPECT_LT(length(box.centre() - Vec3{1, 2, 3}), 1e-15);
    EXPECT_EQ(scene.quantity, Quantity::photometric);  // lumens are
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(3, 0.0));
}

TEST(Project, DiscsHaveTheAreaOfADiscAndFaceTheirAim) {
    const Scene scene =
        parse(lamp("shape = \"disc\"\naim = [1, -1, 0]\nradius = 0.5\nwatts = 10\n"));
    EXPECT_NEAR(area_of(scene), pi * 0.25, 1e-14);
    EXPECT_NEAR(flux_of(scene), 10, 1e-12);
    EXPECT_EQ(scene.quantity, Quantity::radiometric);
    const Vec3 aim = normalized(Vec3{1, -1, 0});
    for (const Polygon& polygon : scene.polygons) {
        EXPECT_LT(length(scene.normal(polygon) - aim), 1e-12);
        for (const std::uint32_t corner : polygon.indices())
            EXPECT_LT(length(scene.points[corner] - Vec3{1, 2, 3}), 0.5 * 1.01);
    }
}

TEST(Project, SpheresAreClosedAndFaceOutwards) {
    const Scene scene = parse(lamp("shape = \"sphere\"\nradius = 2\nexitance = [1, 2, 3]\n"));
    EXPECT_NEAR(area_of(scene), 4 * pi * 4, 1e-12);
    EXPECT_EQ(scene.materials[0].exitance, (Spectrum{1 / 1.0, 2, 3}));
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    Vec3 sum;  // of the vector areas: zero for what is closed
    for (const Polygon& polygon : scene.polygons) {
        const auto corners = scene.corners(polygon);
        const std::span<const Vec3> c(corners.data(), polygon.size());
        EXPECT_GT(dot(unit_normal(c), centroid(c) - Vec3{1, 2, 3}), 0);
        EXPECT_LT(planarity_error(c), 1e-14);
        sum += vector_area(c);
        for (std::uint32_t i = 0; i < polygon.size(); ++i)
            ++edges[{polygon.corners[i], polygon.corners[(i + 1) % polygon.size()]}];
    }
    EXPECT_LT(length(sum), 1e-12);
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
}

RC_GTEST_PROP(Project, AnyLampHasTheFluxItAsksFor, ()) {
    const auto number = [](int from, int to) { return *rc::gen::inRange(from, to) / 100.0; };
    const std::string shape = *rc::gen::element<std::string>("rectangle", "disc", "sphere");
    const double lumens = number(1, 1000000);
    std::string keys = "shape = \"" + shape + "\"\nlumens = " + std::to_string(lumens) + "\n";
    keys += "color = [" + std::to_string(number(1, 100)) + ", " + std::to_string(number(0, 100)) +
            ", " + std::to_string(number(0, 100)) + "]\n";
    const std::string aim = "aim = [" + std::to_string(number(-100, 100)) + ", " +
                            std::to_string(number(-100, 100)) + ", " +
                            std::to_string(number(1, 100)) + "]\n";
    const std::string size = std::to_string(number(1, 300));
    if (shape != "sphere") keys += aim;
    keys += shape == "rectangle" ? "width = " + size + "\nheight = 0.3\nup = [0.1, 1, 0.2]\n"
                                 : "radius = " + size + "\n";
    RC_ASSERT(std::abs(flux_of(parse(lamp(keys))) / lumens - 1) < 1e-12);
}

class ProjectFiles : public ::testing::Test {
  protected:
    Folder folder_;

    std::filesystem::path square() { return folder_.write("square.glb", testing::square_glb()); }
    std::filesystem::path project(const std::string& text, const std::string& name = "p.toml") {
        return folder_.write(name, text);
    }
};

TEST_F(ProjectFiles, GeometryIsScaledTurnedAndMoved) {
    square();  // corners (0,0,5) (2,0,5) (2,3,5) (0,3,5), facing +z, camera at (1, 2, 3)
    const Scene scene = read_scene(project(
        "[[geometry]]\nfile = \"square.glb\"\nunit = \"cm\"\nscale = 2\nrotate = [0, 2, 0, 90]\n"
        "translate = [10, 0, 0]\n"));
    // Half a turn of a right angle about y: z becomes x, x becomes −z.
    ASSERT_EQ(scene.points.size(), 4U);
    EXPECT_LT(length(scene.points[2] - Vec3{10 + 0.1, 0.06, -0.04}), 1e-12);
    EXPECT_LT(length(scene.normals[2] - Vec3{1, 0, 0}), 1e-12);
    EXPECT_LT(length(scene.normal(scene.polygons[0]) - Vec3{1, 0, 0}), 1e-12);
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_LT(length(scene.cameras[0].eye - Vec3{10 + 0.06, 0.04, -0.02}), 1e-12);
    EXPECT_NEAR(*scene.cameras[0].near, 0.1 * 0.02, 1e-12);
    EXPECT_EQ(scene.quantity, Quantity::photometric);  // of the glTF, which emits
}

TEST_F(ProjectFiles, FilesWithZUpAreStoodUp) {
    square();
    const Scene scene = read_scene(project("[[geometry]]\nfile = \"square.glb\"\nup = \"z\"\n"));
    EXPECT_LT(length(scene.points[2] - Vec3{2, 5, -3}), 1e-12);
    EXPECT_LT(length(scene.normal(scene.polygons[0]) - Vec3{0, 1, 0}), 1e-12);
}

TEST_F(ProjectFiles, MaterialsAreChangedByPattern) {
    square();
    const Scene scene = read_scene(project(
        "[[geometry]]\nfile = \"square.glb\"\n[[material]]\nmatch = \"gl?w\"\n"
        "reflectance = 0.25\nluminance = [1, 2, 3]\ngroup = \"signs\"\ntwo_sided = false\n"));
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.reflectance, Spectrum(3, 0.25));
    EXPECT_NEAR(material.exitance[2], 3 * pi, 1e-12);
    EXPECT_EQ(material.group, "signs");
    EXPECT_FALSE(material.two_sided);
    EXPECT_EQ(make_groups(scene, Grouping::file).groups[0].name, "signs");
}

TEST_F(ProjectFiles, QuantityIsTheProjects) {
    square();
    const Scene lumens = read_scene(square());
    const Scene watts =
        read_scene(project("quantity = \"radiometric\"\n[[geometry]]\nfile = \"square.glb\"\n"));
    EXPECT_EQ(watts.quantity, Quantity::radiometric);
    // White RGB light has 179 lm/W (docs/units.md).
    EXPECT_NEAR(watts.materials[0].exitance[0], lumens.materials[0].exitance[0] / 179, 1e-12);
    ASSERT_EQ(watts.warnings.size(), 1U);
    EXPECT_NE(watts.warnings[0].what.find("179 lm/W"), std::string::npos);
    const Scene bare =
        read_scene(project("quantity = \"unitless\"\n[[geometry]]\nfile = \"square.glb\"\n"));
    EXPECT_EQ(bare.materials[0].exitance, lumens.materials[0].exitance);
}

TEST_F(ProjectFiles, ProjectsIncludeProjects) {
    square();
    project("[[geometry]]\nfile = \"../square.glb\"\n[solve]\nerror = 0.1\n", "inner/inner.toml");
    const Scene scene =
        read_scene(project("[[geometry]]\nfile = \"inner/inner.toml\"\ntranslate = [1, 0, 0]\n"
                           "[[geometry]]\nfile = \"square.glb\"\n[solve]\nerror = 0.2\n"));
    EXPECT_EQ(scene.polygons.size(), 4U);
    EXPECT_EQ(scene.points[0] - scene.points[4], (Vec3{1, 0, 0}));
    ASSERT_EQ(scene.settings.size(), 2U);
    EXPECT_EQ(scene.settings.back().value, "0.2");  // the outer one comes last and wins
}

// The first project may name what it likes; one that it names stays in the first one's folder.
TEST_F(ProjectFiles, ProjectsThatAreNamedStayInTheFirstOnesFolder) {
    const auto outside = square();
    folder_.write("lamp.ies",
                  "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0 1 1 50\n0 90\n0\n1 1\n");
    folder_.write("sky.hdr", "none");
    folder_.write("outside.mgf", "m grey =\n");
    const auto include = [&](const std::string& text) {
        project(text, "scene/parts/inner.toml");
        return read_scene(
            project("[[geometry]]\nfile = \"parts/inner.toml\"\n", "scene/outer.toml"));
    };
    const std::string inner = (folder_.path() / "scene/parts/inner.toml").string();
    const std::string held = "expected a file inside the folder of the first project";
    for (const std::string& file : {std::string("../../square.glb"), outside.string()}) {
        EXPECT_EQ(
            read_scene(project("[[geometry]]\nfile = \"" + file + "\"\n", "scene/parts/own.toml"))
                .polygons.size(),
            2U);
        expect_refused([&] { include("[[geometry]]\nfile = \"" + file + "\"\n"); }, inner + ":2:8",
                       held);
    }
    expect_refused(
        [&] {
            include(
                "[[luminaire]]\nname = \"l\"\nfile = \"../../lamp.ies\"\nposition = [0, 0, 0]\n");
        },
        inner + ":3:8", held);
    expect_refused([&] { include("[sky]\nmodel = \"map\"\nfile = \"../../sky.hdr\"\n"); },
                   inner + ":3:8", held);
    // A link out of the folder is no way out.
    std::filesystem::create_symlink(outside, folder_.path() / "scene/parts/link.glb");
    expect_refused([&] { include("[[geometry]]\nfile = \"link.glb\"\n"); }, inner + ":2:8", held);
    // Up, but not out.
    folder_.write("scene/own.glb", testing::square_glb());
    EXPECT_EQ(include("[[geometry]]\nfile = \"../own.glb\"\n").polygons.size(), 2U);
    // An MGF that a project names is not the first file either.
    const auto included = folder_.path() / "outside.mgf";
    const auto mgf = folder_.write("scene/room.mgf", "i " + included.string() + "\n");
    EXPECT_NO_THROW(read_scene(mgf));
    EXPECT_NE(testing::refusal([&] {
                  read_scene(project("[[geometry]]\nfile = \"room.mgf\"\n", "scene/outer.toml"));
              }).find("expected a file inside the scene's folder"),
              std::string::npos);
}

TEST_F(ProjectFiles, DaylightIsPhotometricUnlessSomethingSaysOtherwise) {
    for (const std::string light : {"[sun]\naltitude = 30\n", "[sky]\nmodel = \"overcast\"\n"}) {
        const std::string bare =
            "[[material]]\nname = \"grey\"\nreflectance = 0.5\n[[polygon]]\nmaterial = \"grey\"\n"
            "corners = [[0, 0, 0], [0, 0, 1], [1, 0, 1]]\n";
        EXPECT_EQ(read_scene(project(bare)).quantity, Quantity::unitless);
        EXPECT_EQ(read_scene(project(bare + light)).quantity, Quantity::photometric);
        const Scene watts = read_scene(project(
            bare + light +
            "[[luminaire]]\nname = \"l\"\nshape = \"point\"\nposition = [0, 0, 0]\nwatts = 1\n"));
        EXPECT_EQ(watts.quantity, Quantity::radiometric);
        EXPECT_EQ(read_scene(project("quantity = \"unitless\"\n" + bare + light)).quantity,
                  Quantity::unitless);
    }
}

TEST_F(ProjectFiles, CyclesShowTheChain) {
    const auto a = project("[[geometry]]\nfile = \"b.toml\"\n", "a.toml");
    const auto b = project("\n[[geometry]]\nfile = \"./c.toml\"\n", "b.toml");
    const auto c =
        project("[[geometry]]\nfile = \"../" + folder_.path().filename().string() + "/a.toml\"\n",
                "c.toml");
    expect_refused([&] { read_scene(a); }, (folder_.path() / "c.toml").string() + ":2:8",
                   "includes itself: a.toml → b.toml → c.toml → a.toml");
    const auto self = project("[[geometry]]\nfile = \"self.toml\"\n", "self.toml");
    expect_refused([&] { read_scene(self); }, self.string() + ":2:8", "self.toml → self.toml");
}

TEST_F(ProjectFiles, ProjectsThatDoubleAtEveryStepComeToAnEnd) {
    for (int i = 0; i < 30; ++i) {
        const std::string next = "[[geometry]]\nfile = \"" + std::to_string(i + 1) + ".toml\"\n";
        project(next + next, std::to_string(i) + ".toml");
    }
    project("", "30.toml");
    EXPECT_NE(testing::refusal([&] { read_scene(folder_.path() / "0.toml"); }).find("too often"),
              std::string::npos);
}

TEST_F(ProjectFiles, MissingFilesAreNamedWhereTheyAreAskedFor) {
    const auto file = project("[[geometry]]\nfile = \"gone.glb\"\n");
    expect_refused([&] { read_scene(file); }, file.string() + ":2:8", "gone.glb");
    const auto folder = project("[[geometry]]\nfile = \".\"\n");
    EXPECT_NE(testing::refusal([&] { read_scene(folder); }).find("a folder"), std::string::npos);
}

TEST(Project, ErrorsNameThePlaceAndWhatWasExpected) {
    const auto refused = [](const std::string& from, const std::string& to,
                            const std::string& place, const std::string& words) {
        const std::string text = replaced(everything, from, to);
        expect_refused([&] { parse(text); }, "t.toml:" + place, words);
    };
    refused("title =", "titel =", "1:1", "did you mean 'title'?");
    refused("\"Every table\"", "7", "1:9", "title: found the number '7', expected a string");
    refused("\"Every table\"", "\"Every", "1:15", "not TOML");
    refused("photometric", "photo", "2:12", "radiometric, photometric or unitless");
    refused("photometric", "unitless", "11:13", "'luminance' is photometric");
    refused("[[material]]", "[material]", "8:1", "not TOML");
    refused("[[polygon]]", "[[poligon]]", "19:3", "did you mean 'polygon'?");
    refused("[0.7, 0.6, 0.5]", "[0.7, 0.6]", "6:15", "found an array of 2, expected 3 numbers");
    refused("[0.7, 0.6, 0.5]", "[0.7, 1.6, 0.5]", "6:21", "from 0 to 1");
    refused("[0.7, 0.6, 0.5]", "[0.7, nan, 0.5]", "6:21", "a number from 0 to 1");
    refused("[0.7, 0.6, 0.5]", "-0.1", "6:15", "found the number '-0.1'");
    refused("[0.7, 0.6, 0.5]", "inf", "6:15", "a number from 0 to 1");
    refused("reflectance = 0\n", "reflectance = 0\nexitance = 1\n", "12:13", "found both");
    refused("two_sided = true", "two_sided = 1", "13:13", "true or false");
    refused("match = \"pai*\"", "match = \"wall*\"", "16:9", "there are: paint, panel");
    refused("match = \"pai*\"", "name = \"paint\"", "16:8", "already a material");
    refused("match = \"pai*\"\n", "", "15:1", "neither 'match' nor 'name'");
    refused("material = \"paint\"", "material = \"pant\"", "21:12", "did you mean 'paint'?");
    refused("patches = 4", "patches = 0", "22:11", "a whole number from 1 to 250000");
    refused("patches = 4", "patches = 4000000000", "22:11", "a whole number from 1 to 250000");
    refused("patches = 4", "patches = 1.5", "22:11", "a whole number");
    refused("[1, 0, 1], [1, 0, 0]]", "[1, 0, 0], [0, 0, 0], [1, 1, 1]]", "23:11",
            "found 5 corners");
    refused("[1, 0, 1], [1, 0, 0]]", "[1, 0, \"a\"], [1, 0, 0]]", "23:41", "the string 'a'");
    refused("[1, 0, 1], [1, 0, 0]]", "[1, 0, 1e10], [1, 0, 0]]", "23:41",
            "a number from -1e+09 to 1e+09");
    refused("shape = \"disc\"", "shape = \"cube\"", "31:9",
            "rectangle, disc, sphere, point or spot");
    refused("radius = 0.1", "radius = 0", "34:10", "a number from 1e-09 up");
    refused("radius = 0.1", "width = 0.1", "29:1", "has no 'radius'");
    refused("aim = [0, -1, 0]", "aim = [0, 0, 0]", "33:7", "found the zero vector");
    refused("lumens = 800", "lumens = -800", "35:10", "a number from 0");
    refused("lumens = 800", "lumens = 800\nexitance = 3", "29:1", "found several of");
    refused("lumens = 800", "", "29:1", "found none of");
    refused("[1, 0.8, 0.6]", "[0, 0, 0]", "36:9", "not black");
    refused("look_at = [0, 1, 0]", "look_at = [1, 1.6, 3]", "41:11", "the same point");
    refused("look_at = [0, 1, 0]", "look_at = [1, 9, 3]", "42:6", "along the line of sight");
    refused("fov = 60", "fov = 180", "43:7", "0.01 to 179");
    refused("columns = 10", "columns = 100000", "50:11", "1 to 10000");
    refused("columns = 10", "columns = -1", "50:11", "1 to 10000");
    refused("normal = [0, 1, 0]", "normal = [0, 0, 0]", "52:10", "found the zero vector");
    refused("v = [0, 0, 1]", "v = 1", "49:5", "3 numbers in brackets");
    refused("seed = 7", "seed = [7]", "58:8", "found an array");
    refused("seed = 7", "seed = 2020-01-01", "58:8", "the date or time");
}

TEST(Project, EveryTruncationIsRefusedOrAPart) {
    for (std::size_t n = 0; n < everything.size(); ++n)
        expect_sound([&] { parse(everything.substr(0, n)); }, "t.toml", true);
}

TEST(Project, DeepNestingIsRefused) {
    const std::string deep = "title = " + std::string(100'000, '[');
    EXPECT_TRUE(testing::sound_within(64, [&] { parse(deep); }));
    EXPECT_NE(testing::refusal([&] { parse(deep); }).find("not TOML"), std::string::npos);
}

TEST(Project, FilesThatNameEachOtherComeToAnEnd) {
    const Folder folder;
    const auto naming = [&](const std::string& name, const std::string& file) {
        return folder.write(name, "[[geometry]]\nfile = \"" + file + "\"\n");
    };
    const auto a = naming("a.toml", "b.toml");
    const auto b = naming("b.toml", "a.toml");
    expect_refused([&] { read_scene(a); }, b.string() + ":2:8", "the project includes itself");
    naming("p0.toml", "p1.toml");
    folder.write("p1.toml", "title = \"the last\"\n");
    naming("p2.toml", "p0.toml");
    ReadOptions shallow;
    shallow.max_include_depth = 2;
    expect_refused([&] { read_scene(folder.path() / "p2.toml", shallow); },
                   (folder.path() / "p0.toml").string() + ":2:8", "--max-include-depth raises");
    ReadOptions few;
    few.max_files = 2;
    expect_refused([&] { read_scene(folder.path() / "p2.toml", few); },
                   (folder.path() / "p0.toml").string() + ":2:8", "--max-files raises");
    shallow.max_include_depth = few.max_files = 3;
    EXPECT_TRUE(read_scene(folder.path() / "p2.toml", shallow).polygons.empty());
    // Each names the one before twice.
    for (int i = 2; i < 30; ++i) {
        const std::string before = "[[geometry]]\nfile = \"p" + std::to_string(i - 1) + ".toml\"\n";
        folder.write("p" + std::to_string(i) + ".toml", before + before);
    }
    EXPECT_TRUE(testing::quick([&] {
        EXPECT_NE(
            testing::refusal([&] { read_scene(folder.path() / "p29.toml"); }).find("--max-files"),
            std::string::npos);
    }));
}

TEST(Project, ManyMaterialsTakeLittleTime) {
    std::string text;
    for (int i = 0; i < 4000; ++i)
        text += "[[material]]\nname = \"m" + std::to_string(i) + "\"\nreflectance = 0.5\n";
    // A search through all names for each pair of materials took minutes.
    EXPECT_TRUE(testing::quick([&] { EXPECT_EQ(parse(text).materials.size(), 4000U); }));
}

RC_GTEST_PROP(Project, AnyMutationIsReadOrRefused, ()) {
    std::string text = everything;
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i)
        text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
    expect_sound([&] { parse(text); }, "t.toml", true);
}

RC_GTEST_PROP(Project, AnyMutationOfAValueIsReadOrRefused, ()) {
    static const std::vector<std::string> values{
        "0",    "-1",   "1e308",          "nan",       "inf",   "\"\"",       "[]",     "{}",
        "[[]]", "true", "99999999999999", "[0, 0, 0]", "\"*\"", "1979-05-27", "[1, 2]", "0.5"};
    std::vector<std::size_t> begins;
    for (std::size_t i = everything.find(" = "); i != std::string::npos;
         i = everything.find(" = ", i + 1))
        begins.push_back(i + 3);
    const std::size_t at = *rc::gen::elementOf(begins);
    std::string text = everything;
    text.replace(at, text.find('\n', at) - at, *rc::gen::elementOf(values));
    expect_sound([&] { parse(text); }, "t.toml", true);
}

TEST(Project, TheProjectsOwnScenesAreSound) {
    const std::filesystem::path scenes = std::filesystem::path(EXITANCE_SOURCE_DIR) / "scenes";
    const Scene cornell = read_scene(scenes / "cornell.toml");
    const Scene geometry = read_scene(scenes / "cornell.geom");
    EXPECT_TRUE(cornell.warnings.empty());
    EXPECT_TRUE(geometry.warnings.empty());
    ASSERT_EQ(cornell.polygons.size(), geometry.polygons.size());
    // The same box twice: same area, same flux.
    EXPECT_NEAR(area_of(cornell), area_of(geometry), 1e-6);
    EXPECT_NEAR(flux_of(cornell), flux_of(geometry), 1e-4);
}

}  // namespace
}  // namespace exitance
