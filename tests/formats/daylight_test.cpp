// SPDX-License-Identifier: Apache-2.0
// [site], [sky], [sun], [[scenes]] and environment maps of projects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "exitance/render/image.h"
#include "exitance/scene/distant_light.h"
#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::Folder;

constexpr double degree = std::numbers::pi / 180;

const std::string floor = R"(quantity = "photometric"

[[material]]
name = "grey"
reflectance = 0.3

[[polygon]]
material = "grey"
corners = [[0, 0, 0], [0, 0, 4], [4, 0, 4], [4, 0, 0]]
)";

const std::string munich = R"([site]
latitude = 48.14
longitude = 11.58
time = 2026-06-21T13:17:00+02:00
)";

Scene read(Folder& folder, const std::string& text) {
    return read_scene(folder.write("day.toml", floor + text));
}

TEST(DaylightKeys, PlaceAndTimePutTheSunInTheSky) {
    Folder folder;
    const Scene scene = read(folder, munich + "[sky]\nmodel = \"clear\"\n[sun]\n");
    ASSERT_EQ(scene.distant.size(), 2U);
    const DistantLight &sky = scene.distant[0], &sun = scene.distant[1];
    EXPECT_EQ(sky.group, "sky");
    EXPECT_EQ(sun.group, "sun");
    // Midsummer noon: 90° − latitude + 23.44° high, in the south (+z).
    EXPECT_NEAR(std::asin(sun.direction.y) / degree, 90 - 48.14 + 23.44, 0.05);
    EXPECT_NEAR(sun.direction.x, 0, 0.02);
    EXPECT_GT(sun.direction.z, 0);
    EXPECT_EQ(sky.model.sun, sun.direction);
    EXPECT_NEAR(sun.diameter, 0.53 * degree, 1e-12);
    // RP-21 by hand: 800 + 15500 √sin 65.3°, and 127500 · 0.967 · exp(−0.21 / sin 65.3°).
    EXPECT_NEAR(horizontal_irradiance(sky), 15574, 20);
    EXPECT_NEAR(sun.irradiance, 97900, 500);
}

TEST(DaylightKeys, EveryModelGivesWhatIsAskedFor) {
    Folder folder;
    for (const std::string model :
         {"model = \"overcast\"", "model = \"uniform\"", "model = \"clear\"",
          "model = \"cie\"\ntype = 3", "model = \"cie\"\ntype = 14",
          "model = \"perez\"\ndirect_normal = 600\ndiffuse_horizontal = 120"}) {
        const Scene scene = read(folder, munich + "[sky]\nhorizontal = 12000\n" + model + "\n");
        EXPECT_NEAR(horizontal_irradiance(scene.distant.back()), 12000, 1) << model;
        EXPECT_EQ(scene.distant.size(), model.find("perez") != std::string::npos ? 2U : 1U);
    }
    const Scene zenith =
        read(folder, "[sky]\nmodel = \"overcast\"\nzenith_luminance = 3000\ndimming = 0.5\n");
    EXPECT_NEAR(luminance(zenith.distant[0].radiance({0, 1, 0})), 1500, 1e-9);
    EXPECT_NEAR(horizontal_irradiance(zenith.distant[0]), 1500 * 7 * std::numbers::pi / 9, 2);
}

TEST(DaylightKeys, ASunByAnglesOrDirection) {
    Folder folder;
    const Scene west =
        read(folder, "[sun]\naltitude = 30\nazimuth = 270\nnormal = 40000\ndiameter = 0\n");
    ASSERT_EQ(west.distant.size(), 1U);
    EXPECT_NEAR(length(west.distant[0].direction - Vec3{-std::sqrt(0.75), 0.5, 0}), 0, 1e-12);
    EXPECT_EQ(west.distant[0].irradiance, 40000);
    EXPECT_EQ(west.distant[0].diameter, 0);
    const Scene below = read(folder, "[sun]\naltitude = -5\n");
    EXPECT_EQ(below.distant[0].irradiance, 0) << "it has set";
}

TEST(DaylightKeys, AMapKeepsItsLight) {
    Folder folder;
    // Even, but for one pixel in the middle row's upper neighbour, seen towards −z.
    Image picture(64, 32);
    for (Vec3f& pixel : picture.pixels) pixel = {100, 200, 300};
    picture.at(32, 10) = {100000, 100000, 100000};
    for (const std::string kind : {".exr", ".hdr"}) {
        write_image(picture, folder.path() / ("sky" + kind));
        const Scene scene =
            read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky" + kind + "\"\nscale = 0.5\n");
        const DistantLight& sky = scene.distant.at(0);
        const double up = (0.2126 * 100 + 0.7152 * 200 + 0.0722 * 300) * std::numbers::pi;
        // The pixel: ΔL · cosθ · solid angle, with cosθ = cos(π (10.5 / 32)).
        const double zenith = std::numbers::pi * 10.5 / 32;
        const double solid = (2 * std::numbers::pi / 64) * (std::cos(std::numbers::pi * 10 / 32) -
                                                            std::cos(std::numbers::pi * 11 / 32));
        const double spot = (100000 - up / std::numbers::pi) * std::cos(zenith) * solid;
        EXPECT_NEAR(horizontal_irradiance(sky), 0.5 * (up + spot), 0.01 * (up + spot)) << kind;
        EXPECT_NEAR(sky.radiance({0, -1, 0})[0], 50, 1) << kind;
        // Half a pixel to the right of −z.
        const double round = 2 * std::numbers::pi * 0.5 / 64;
        EXPECT_GT(luminance(sky.radiance({std::sin(zenith) * std::sin(round), std::cos(zenith),
                                          -std::sin(zenith) * std::cos(round)})),
                  20000)
            << kind;
    }
}

// What all cells hold is what all pixels hold, to the roundings of float: of one bright pixel
// anywhere, of pictures finer and coarser than the cells, turned by any angle.
TEST(DaylightKeys, APixelOfAMapKeepsItsFlux) {
    Folder folder;
    using std::numbers::pi;
    struct Case {
        int width, height, x, y;
        double rotation;
    };
    for (const Case& c : {Case{64, 32, 40, 3, 0}, Case{64, 33, 7, 16, 0}, Case{64, 32, 0, 0, 33},
                          Case{100, 50, 62, 12, 271.3}, Case{512, 256, 300, 60, 0},
                          Case{1024, 512, 777, 200, 12}, Case{1024, 512, 3, 170, 0}}) {
        Image picture(c.width, c.height);
        picture.at(c.x, c.y) = {1e6F, 2e6F, 3e6F};
        write_image(picture, folder.path() / "sun.exr");
        const Scene scene = read(
            folder,
            fmt::format("[sky]\nmodel = \"map\"\nfile = \"sun.exr\"\nrotation = {}\n", c.rotation));
        const RadianceMap& map = *scene.distant.at(0).map;
        const double cell = 2 * pi / (double(map.side()) * map.side());
        double flux = 0;
        for (std::size_t i = 0; i < map.cells.size(); i += 3) flux += cell * double(map.cells[i]);
        const double top = pi * c.y / c.height, bottom = pi * (c.y + 1) / c.height;
        const double solid = (2 * pi / c.width) * (std::cos(top) - std::cos(bottom));
        EXPECT_NEAR(flux, 1e6 * solid, 1e6 * solid * 1e-6) << c.width << ' ' << c.x << ' ' << c.y;
        EXPECT_LE(cell, 1.001 * (2 * pi / c.width) * (pi / c.height)) << c.width;
        // ∫ cosθ dω of the pixel; where it stands 30° or more high, half a cell is 1 % of that.
        if (bottom > pi / 3) continue;
        const double weighted =
            (2 * pi / c.width) * 0.5 * (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2));
        const double bright = 1e6 * (0.2126 + 2 * 0.7152 + 3 * 0.0722);
        EXPECT_NEAR(horizontal_irradiance(scene.distant[0]), bright * weighted,
                    0.01 * bright * weighted)
            << c.width << ' ' << c.x << ' ' << c.y;
    }
}

TEST(DaylightKeys, AnEvenMapStaysEven) {
    Folder folder;
    for (const auto& [width, height] :
         {std::pair(50, 25), std::pair(64, 32), std::pair(700, 350)}) {
        Image picture(width, height);
        for (Vec3f& pixel : picture.pixels) pixel = {100, 200, 300};
        write_image(picture, folder.path() / "even.exr");
        const Scene scene =
            read(folder, "[sky]\nmodel = \"map\"\nfile = \"even.exr\"\nrotation = 17\n");
        const RadianceMap& map = *scene.distant.at(0).map;
        for (std::size_t i = 0; i < map.cells.size(); ++i)
            ASSERT_NEAR(double(map.cells[i]), 100.0 * double(i % 3 + 1), 1e-3) << width << ' ' << i;
    }
}

TEST(DaylightKeys, PicturesHaveALargestSizeAndFillIt) {
    Folder folder;
    for (const std::string kind : {".exr", ".hdr"}) {
        const std::string sky = "[sky]\nmodel = \"map\"\nfile = \"sky" + kind + "\"\n";
        write_image(Image(64, 32), folder.path() / ("sky" + kind));
        const auto project = folder.write("day.toml", floor + sky);
        ReadOptions few;
        few.max_texture_pixels = 64 * 32 - 1;
        testing::expect_refused([&] { read_scene(project, few); }, project.string() + ":12:8",
                                "64 × 32 pixels, more than 2047; --max-texture-pixels raises");
        few.max_texture_pixels = 64 * 32;
        EXPECT_EQ(read_scene(project, few).distant.size(), 1U);
        ReadOptions small;
        small.max_file_size =
            double(std::filesystem::file_size(folder.path() / ("sky" + kind)) - 1) / (1 << 20);
        EXPECT_NE(testing::refusal([&] { read_scene(project, small); }).find("--max-file-size"),
                  std::string::npos);
    }
    // What a few bytes claim is not set aside: 16384 × 8192 pixels of them.
    folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n\2\2\100");
    EXPECT_TRUE(testing::sound_within(
        64, [&] { read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky.hdr\"\n"); }));
    EXPECT_NE(testing::refusal([&] {
                  read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky.hdr\"\n");
              }).find("16384 × 8192 pixels, but has only"),
              std::string::npos);
    // Runs of no length, as a file that ends has them for a careless reader, fill no line.
    for (const std::string& runs :
         {std::string("\2\2\0\20\0\0", 6), std::string("\2\2\0\20\220\1", 6)}) {
        folder.write("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n" + runs);
        const std::string said =
            testing::refusal([&] { read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky.hdr\"\n"); });
        EXPECT_NE(
            said.find(runs.size() > 4 && runs[4] == 0 ? "run that cannot be" : "ends too early"),
            std::string::npos)
            << said;
    }
    write_image(Image(32, 64), folder.path() / "sky.hdr");
    EXPECT_NE(testing::refusal([&] {
                  read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky.hdr\"\n");
              }).find("expected about twice as wide as high"),
              std::string::npos);
    // The same in the header of an EXR: the attribute dataWindow ends with its last column and row.
    write_image(Image(64, 32), folder.path() / "sky.exr");
    std::ifstream in(folder.path() / "sky.exr", std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    for (const std::string name : {"dataWindow", "displayWindow"}) {
        const std::size_t at = bytes.find(name) + name.size() + 1 + 6 + 4 + 8;
        bytes.replace(at, 8, std::string("\xff\x3f\0\0\xff\x1f\0\0", 8));
    }
    folder.write("sky.exr", bytes);
    const auto exr = [&] { read(folder, "[sky]\nmodel = \"map\"\nfile = \"sky.exr\"\n"); };
    EXPECT_NE(testing::refusal(exr).find("sky.exr"), std::string::npos);
    EXPECT_TRUE(testing::sound_within(256, exr));
}

TEST(DaylightKeys, WrongOnesAreRefusedWhereTheyStand) {
    Folder folder;
    const auto refused = [&](const std::string& text, const std::string& why) {
        const std::string said = testing::refusal([&] { read(folder, text); });
        EXPECT_NE(said.find(why), std::string::npos) << said;
    };
    refused("[sky]\nmodel = \"cloudy\"\n", "day.toml:11:9: model: found the string 'cloudy'");
    refused("[sky]\nmodel = \"cie\"\ntype = 16\n", "day.toml:12:8: type: found");
    refused("[sky]\nmodel = \"clear\"\n", "where the sun stands");
    refused("[sun]\n", "where the sun stands");
    refused("[sky]\nmodel = \"map\"\nfile = \"none.hdr\"\n",
            "day.toml:12:8: file: found the string 'none.hdr', expected a file; there is none at");
    refused("[sky]\nmodel = \"uniform\"\ntype = 3\n", "'type'");
    refused("[site]\nlatitude = 91\nlongitude = 0\ntime = 2026-01-01T12:00:00Z\n[sun]\n",
            "day.toml:11:12: latitude");
    refused("[site]\nlatitude = 1\nlongitude = 0\ntime = 2026-01-01T12:00:00\n[sun]\n",
            "time_zone");
    refused("[site]\nlatitude = 1\nlongitude = 0\ntime = \"noon\"\n[sun]\n",
            "a date and time, like");
    refused("[[scenes]]\nname = \"dark\"\nlihgt = 0\n", "there is no light group 'lihgt'");
    refused("[[scenes]]\nall = 0\n", "has no 'name'");
    std::ofstream(folder.path() / "bad.hdr") << "no picture";
    refused("[sky]\nmodel = \"map\"\nfile = \"bad.hdr\"\n", "is not a Radiance picture");
    std::ofstream(folder.path() / "bad.exr") << "no picture";
    refused("[sky]\nmodel = \"map\"\nfile = \"bad.exr\"\n", "is not an image file");
}

TEST(DaylightKeys, ScenesAndGridsBySpacing) {
    Folder folder;
    const Scene scene = read(folder, munich + R"([sky]
model = "clear"
[[scenes]]
name = "dull"
sky = 0.25
[[grid]]
origin = [0, 0.8, 0]
u = [0, 0, 4]
v = [3, 0, 0]
margin = 0.5
spacing = 0.5
)");
    ASSERT_EQ(scene.light_scenes.size(), 1U);
    EXPECT_EQ(scene.light_scenes[0].factors.at("sky"), 0.25);
    ASSERT_EQ(scene.grids.size(), 1U);
    EXPECT_EQ(scene.grids[0].columns, 6U);
    EXPECT_EQ(scene.grids[0].rows, 4U);
    EXPECT_NEAR(length(scene.grids[0].origin - Vec3{0.5, 0.8, 0.5}), 0, 1e-12);
    EXPECT_NEAR(scene.grids[0].u.z, 3, 1e-12);
}

}  // namespace
}  // namespace exitance
