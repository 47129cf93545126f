// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/afit.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;

const std::string two_plates =
    "Two plates\n"
    "ccw purge\n"
    "points 7 patches 3 attributes 2\n"
    "0 0 0 normal 0 0 2\n"
    "1 0 0 normal 0 0 2\n"
    "1 1 0\n"
    "0 1 0\n"
    "0 0 1\n"
    "1e0 0 1\r\n"
    "+1 1. 1\n"
    "4 1 2 3 4 attribute 2 patch 9\n"
    "\n"
    "3 5 7 6\n"
    "3 5 6 7 patch 4\n"
    "color 0.5 .25 0\n"
    "color 0 0 0 emit 3 2 1 material 7\n";

const std::string view =
    "From above\n"
    "eye 0 0 5 lookat 0 0 0\n"
    "up 0 1 0\n"
    "fovx 60 fovy 40\n"
    "near 0.1 far 50\n"
    "xres 512 yres 256\n"
    "diameter 2.5\n"
    "ambient 1\n"
    "threshold 0.5\n";

Scene parse(const std::string& text) {
    return parse_afit_geometry("t.geom", text);
}

TEST(AfitGeometry, ReadsEveryPart) {
    const Scene scene = parse(two_plates);
    EXPECT_EQ(scene.title, "Two plates");
    EXPECT_EQ(scene.quantity, Quantity::unitless);
    ASSERT_EQ(scene.points.size(), 7U);
    EXPECT_EQ(scene.points[6], (Vec3{1, 1, 1}));
    EXPECT_EQ(scene.normals[0], (Vec3{0, 0, 1}));  // of unit length
    EXPECT_EQ(scene.normals[2], Vec3{});
    ASSERT_EQ(scene.polygons.size(), 3U);
    EXPECT_EQ(scene.polygons[0].corners, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    EXPECT_EQ(scene.polygons[0].surface, 1U);
    EXPECT_EQ(scene.polygons[0].patches, 9U);
    EXPECT_EQ(scene.polygons[0].line, 11U);
    EXPECT_EQ(scene.polygons[1].corners, (std::array<std::uint32_t, 4>{4, 6, 5, Polygon::none}));
    EXPECT_EQ(scene.polygons[1].surface, 0U);
    EXPECT_EQ(scene.polygons[1].patches, 1U);
    EXPECT_EQ(scene.polygons[2].patches, 4U);
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[0].reflectance, (Spectrum{0.5, 0.25, 0}));
    EXPECT_FALSE(scene.materials[0].emits());
    EXPECT_EQ(scene.materials[1].exitance, (Spectrum{3, 2, 1}));
    EXPECT_EQ(scene.materials[1].reflectance_file, 7);
    EXPECT_EQ(scene.materials[1].place.line, 16U);
    EXPECT_FALSE(scene.materials[0].two_sided);
    EXPECT_NEAR(scene.area(scene.polygons[0]), 1, 1e-15);
}

TEST(AfitGeometry, ClockwiseOrderIsTurnedRound) {
    const Vec3 ccw = parse(two_plates).normal(parse(two_plates).polygons[0]);
    std::string text = two_plates;
    text.replace(text.find("ccw"), 3, "cw");
    const Scene scene = parse(text);
    EXPECT_EQ(scene.normal(scene.polygons[0]), -ccw);
    EXPECT_EQ(scene.normal(scene.polygons[2]), (Vec3{0, 0, -1}));
}

TEST(AfitGeometry, NopurgeMakesWhatDoesNotEmitTwoSided) {
    std::string text = two_plates;
    text.replace(text.find("purge"), 5, "nopurge");
    const Scene scene = parse(text);
    EXPECT_TRUE(scene.materials[0].two_sided);
    EXPECT_FALSE(scene.materials[1].two_sided);
}

TEST(AfitGeometry, SelectionLineMayBeMissing) {
    const Scene scene =
        parse("t\npoints 3 patches 1 attributes 1\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\ncolor 1 1 1");
    EXPECT_EQ(scene.polygons.size(), 1U);
}

TEST(AfitGeometry, ErrorsNameThePlaceAndWhatWasExpected) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = two_plates;
        text.replace(text.find(from), from.size(), to);
        return [text] { parse(text); };
    };
    expect_refused(with("ccw", "ccv"), "t.geom:2:1", "did you mean 'ccw'?");
    expect_refused(with("points 7", "points -7"), "t.geom:3:8", "found '-7', expected a count");
    expect_refused(with("points 7", "points 99999999999999999999"), "t.geom:3:8", "a count");
    expect_refused(with("points 7", "points 7.5"), "t.geom:3:8", "a count");
    expect_refused(with("points 7", "points 100000"), "t.geom:11:7", "expected 'normal'");
    expect_refused(with("attributes 2", "attributes 3"), "t.geom:17:1", "attribute 3 of 3");
    expect_refused(with("attributes 2", "attributes 0"), "t.geom:3:31", "at least one");
    expect_refused(with("attributes 2", "attributes 1"), "t.geom:11:21", "1 to 1");
    expect_refused(with("1 1 0", "1 nan 0"), "t.geom:6:3", "found 'nan', expected a coordinate");
    expect_refused(with("1 1 0", "1 1e999 0"), "t.geom:6:3", "a coordinate");
    expect_refused(with("1 1 0", "1 1 0 0"), "t.geom:6:7", "point 3 of 7");
    expect_refused(with("1 1 0", "1 1"), "t.geom:6:4", "found the end of the line");
    expect_refused(with("4 1 2", "5 1 2"), "t.geom:11:1", "3 or 4");
    expect_refused(with("4 1 2", "4 0 2"), "t.geom:11:3", "1 to 7");
    expect_refused(with("4 1 2", "4 8 2"), "t.geom:11:3", "1 to 7");
    expect_refused(with("patch 9", "patch 0"), "t.geom:11:29", "a number of patches");
    expect_refused(with("patch 9", "patch 4000000000"), "t.geom:11:29", "a number of patches");
    expect_refused(with("patch 9", "pitch 9"), "t.geom:11:23", "polygon 1 of 3");
    expect_refused(with("color 0.5", "color 1.5"), "t.geom:15:7", "found '1.5'");
    expect_refused(with("color 0.5", "color -1"), "t.geom:15:7", "a reflectance");
    expect_refused(with("emit 3", "emit -3"), "t.geom:16:18", "an exitance");
    expect_refused(with("material 7\n", "material 7\nmore"), "t.geom:17:1", "end of the file");
    expect_refused([] { parse(""); }, "t.geom:1:1", "points n patches n");
    expect_refused([] { parse(std::string("\0\1\2\xff\n\n\x7f", 7)); }, "t.geom:3:1", "found '?'");
}

TEST(AfitGeometry, EveryTruncationIsRefusedOrWhole) {
    // The last number may lose digits without harm; before that something is always missing.
    const std::size_t last_word = two_plates.rfind("emit");
    for (std::size_t n = 0; n < two_plates.size(); ++n) {
        const std::string text = two_plates.substr(0, n);
        expect_sound([&] { parse(text); }, "t.geom", true);
        if (n < last_word - 7) {
            EXPECT_ANY_THROW(parse(text)) << n;
        }
    }
}

TEST(AfitGeometry, AbsurdCountsDoNotAllocate) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    // The limit bites: what does allocate is told from what does not.
    EXPECT_FALSE(testing::sound_within(32, [] { std::vector<char>(std::size_t{64} << 20, 1); }));
#endif
    const std::string header = "t\nccw\npoints 134217728 patches 134217728 attributes 134217728\n";
    EXPECT_TRUE(testing::sound_within(32, [&] { parse(header + "0 0 0\n"); }));
    expect_refused([&] { parse(header + "0 0 0\n"); }, "t.geom:5:1", "point 2 of 134217728");
}

RC_GTEST_PROP(AfitGeometry, AnyMutationIsReadOrRefused, ()) {
    std::string text = two_plates;
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i)
        text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
    expect_sound([&] { parse(text); }, "t.geom", true);
}

RC_GTEST_PROP(AfitGeometry, RandomWordsAreReadOrRefused, ()) {
    static const std::vector<std::string> words{
        "points", "patches", "attributes", "normal", "color", "emit",       "patch", "attribute",
        "0",      "1",       "-1",         "4",      "nan",   "1e308",      "inf",   "\n",
        "cw",     "nopurge", "3",          "\n",     "0.5",   "99999999999"};
    std::string text = "t\n";
    for (const auto& word :
         *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(words)))
        text += word + " ";
    expect_sound([&] { parse(text); }, "t.geom", true);
}

TEST(AfitDisplayFile, ReadsEveryPart) {
    const AfitDisplay d = parse_afit_display("t.display", view);
    EXPECT_EQ(d.comment, "From above");
    EXPECT_EQ(d.eye, (Vec3{0, 0, 5}));
    EXPECT_EQ(d.look_at, Vec3{});
    EXPECT_EQ(d.up, (Vec3{0, 1, 0}));
    EXPECT_EQ(d.fov_x, 60);
    EXPECT_EQ(d.fov_y, 40);
    EXPECT_EQ(d.near, 0.1);
    EXPECT_EQ(d.far, 50);
    EXPECT_EQ(d.width, 512U);
    EXPECT_EQ(d.height, 256U);
    EXPECT_EQ(d.diameter, 2.5);
    EXPECT_EQ(d.ambient, true);
    EXPECT_EQ(d.threshold, 0.5);
    const Camera camera = camera_of(d);
    EXPECT_EQ(camera.fov_y, 40);
    // tan 30° / tan 20°
    EXPECT_NEAR(*camera.aspect, 0.57735026919 / 0.36397023427, 1e-9);
}

TEST(AfitDisplayFile, ErrorsNameThePlace) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = view;
        text.replace(text.find(from), from.size(), to);
        return [text] { parse_afit_display("t.display", text); };
    };
    expect_refused(with("lookat", "lokat"), "t.display:2:11", "did you mean 'lookat'?");
    expect_refused(with("lookat 0 0 0", ""), "t.display:10:1", "expected 'lookat'");
    expect_refused(with("lookat 0 0 0", "lookat 0 0 5"), "t.display:2:1", "the same point");
    expect_refused(with("up 0 1 0", "up 0 0 1"), "t.display:3:1", "line of sight");
    expect_refused(with("up 0 1 0", "eye 0 1 0"), "t.display:3:1", "second time");
    expect_refused(with("fovy 40", "fovy 180"), "t.display:4:14", "an angle");
    expect_refused(with("xres 512", "xres 0"), "t.display:6:6", "pixels");
    expect_refused(with("far 50", "far 0.05"), "t.display:10:1", "far is not beyond near");
    expect_refused(with("ambient 1", "ambient 2"), "t.display:8:9", "0 or 1");
}

TEST(AfitDisplayFile, EveryTruncationIsReadOrRefused) {
    for (std::size_t n = 0; n < view.size(); ++n)
        expect_sound([&] { parse_afit_display("t.display", view.substr(0, n)); }, "t.display",
                     true);
}

RC_GTEST_PROP(AfitDisplayFile, AnyMutationIsReadOrRefused, ()) {
    std::string text = view;
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i)
        text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
    expect_sound([&] { parse_afit_display("t.display", text); }, "t.display", true);
}

TEST(ReadScene, TakesTheCameraOfTheDisplayFileBeside) {
    const testing::Folder folder;
    const auto geometry = folder.write("plates.geom", two_plates);
    EXPECT_TRUE(read_scene(geometry).cameras.empty());
    folder.write("plates.display", view);
    const Scene scene = read_scene(geometry);
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].eye, (Vec3{0, 0, 5}));
}

TEST(ReadScene, RefusesWhatIsNoFile) {
    const testing::Folder folder;
    const auto missing = folder.path() / "missing.geom";
    expect_refused([&] { read_scene(missing); }, missing.string(), "no such file");
    std::filesystem::create_directories(folder.path() / "folder.geom");
    expect_refused([&] { read_scene(folder.path() / "folder.geom"); },
                   (folder.path() / "folder.geom").string(), "a folder");
    expect_refused([&] { read_scene("/dev/zero"); }, "/dev/zero", "a device");
}

}  // namespace
}  // namespace exitance
