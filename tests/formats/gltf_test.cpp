// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "exitance/scene/read.h"
#include "formats/gltf_samples.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;
using testing::Folder;
using testing::glb;
using testing::square_binary;
using testing::square_glb;
using testing::square_gltf;
using testing::square_json;

constexpr double pi = std::numbers::pi;

Scene parse(const std::string& bytes) {
    return parse_gltf("t.glb", bytes);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

std::string changed_json(const std::string& from, const std::string& to) {
    return replaced(square_json(R"({"byteLength": 112})"), from, to);
}

std::string changed(const std::string& from, const std::string& to) {
    return glb(changed_json(from, to), square_binary());
}

void expect_square(const Scene& scene) {
    ASSERT_EQ(scene.polygons.size(), 2U);
    ASSERT_EQ(scene.points.size(), 4U);
    EXPECT_EQ(scene.points[2], (Vec3{2, 3, 5}));  // scaled by the child, then moved by its parent
    EXPECT_EQ(scene.normals[2], (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.normal(scene.polygons[1]), (Vec3{0, 0, 1}));
    EXPECT_NEAR(scene.area(scene.polygons[0]) + scene.area(scene.polygons[1]), 6, 1e-14);
}

TEST(Gltf, ReadsNodesTrianglesMaterialsAndCameras) {
    const Scene scene = parse(square_glb());
    expect_square(scene);
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    ASSERT_EQ(scene.materials.size(), 1U);
    const Material& glow = scene.materials[0];
    EXPECT_EQ(glow.name, "glow");
    EXPECT_EQ(glow.reflectance, (Spectrum{0.1, 0.2, 0.3}));
    EXPECT_TRUE(glow.two_sided);
    // 10 cd/m² in every direction leave π · 10 lm/m².
    EXPECT_NEAR(glow.exitance[0], 10 * pi, 1e-12);
    EXPECT_NEAR(glow.exitance[1], 5 * pi, 1e-12);
    EXPECT_NEAR(glow.exitance[2], 2.5 * pi, 1e-12);
    ASSERT_EQ(scene.surfaces.size(), 1U);
    EXPECT_EQ(scene.surfaces[0].name, "square");
    ASSERT_EQ(scene.cameras.size(), 1U);
    const Camera& camera = scene.cameras[0];
    EXPECT_EQ(camera.name, "eye");
    EXPECT_EQ(camera.eye, (Vec3{1, 2, 3}));
    EXPECT_EQ(camera.look_at, (Vec3{1, 2, 2}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
    EXPECT_NEAR(camera.fov_y, 45, 1e-12);
    EXPECT_EQ(camera.aspect, 1.5);
    EXPECT_EQ(camera.near, 0.1);
    EXPECT_FALSE(camera.far);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Gltf, BuffersMayLieBesideTheFileOrInTheText) {
    const Folder folder;
    const auto file = folder.write("square.gltf", square_gltf());
    expect_refused([&] { read_gltf(file); }, file.string() + ":29:42", "square data.bin");
    folder.write("square data.bin", square_binary());
    expect_square(read_gltf(file));
    folder.write("square data.bin", square_binary().substr(1));
    expect_refused([&] { read_gltf(file); }, file.string() + ":1:1", "111");

    // A triangle of nine floats 0 or 1: 0x3f800000 is "AACAPw" at a multiple of three bytes.
    const std::string json = R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                             "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
                             R"("}]})";
    const Scene scene = parse(json);
    ASSERT_EQ(scene.polygons.size(), 1U);
    EXPECT_EQ(scene.points[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(scene.points[2], (Vec3{0, 1, 0}));
}

TEST(Gltf, MirroringTransformsKeepTheFrontInFront) {
    const Scene scene = parse(changed("[2, 3, 1]", "[-2, 3, 1]"));
    EXPECT_EQ(scene.points[2], (Vec3{-2, 3, 5}));
    for (const Polygon& polygon : scene.polygons) EXPECT_EQ(scene.normal(polygon), (Vec3{0, 0, 1}));
    EXPECT_EQ(scene.normals[2], (Vec3{0, 0, 1}));
}

TEST(Gltf, MatrixAndRotationAgree) {
    // A quarter turn about x: y becomes z, z becomes −y.
    const std::string by_matrix =
        changed("\"scale\": [2, 3, 1]", "\"matrix\": [2,0,0,0, 0,0,3,0, 0,-1,0,0, 0,0,0,1]");
    const std::string by_rotation = changed(
        "\"scale\": [2, 3, 1]",
        "\"scale\": [2, 3, 1], \"rotation\": [0.7071067811865476, 0, 0, 0.7071067811865476]");
    const Scene a = parse(by_matrix), b = parse(by_rotation);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i)
        EXPECT_LT(length(a.points[i] - b.points[i]), 1e-12);
    EXPECT_LT(length(a.points[2] - Vec3{2, 0, 8}), 1e-12);
    EXPECT_LT(length(a.normal(a.polygons[0]) - Vec3{0, -1, 0}), 1e-12);
}

TEST(Gltf, StripsAndFansFaceLikeTheirFirstTriangle) {
    // Strip order 0 1 3 2 and fan order 0 1 2 3 both cover the square.
    const std::string strip =
        square_binary().substr(0, 96) + testing::bytes_of<std::uint16_t>({0, 1, 3, 2, 2, 2, 0, 0});
    for (const auto& [mode, count, binary] :
         {std::tuple{"5", "4", strip}, std::tuple{"5", "6", strip},
          std::tuple{"6", "4",
                     square_binary().substr(0, 96) +
                         testing::bytes_of<std::uint16_t>({0, 1, 2, 3, 0, 0, 0, 0})}}) {
        std::string json =
            changed_json("\"indices\": 2", "\"indices\": 2, \"mode\": " + std::string(mode));
        json = replaced(json, "\"count\": 6", "\"count\": " + std::string(count));
        const Scene scene = parse(glb(json, binary));
        ASSERT_EQ(scene.polygons.size(), 2U) << mode;
        double area = 0;
        for (const Polygon& polygon : scene.polygons) {
            EXPECT_EQ(scene.normal(polygon), (Vec3{0, 0, 1})) << mode;
            area += scene.area(polygon);
        }
        EXPECT_NEAR(area, 6, 1e-14);
    }
}

TEST(Gltf, SparseAccessorsReplaceElements) {
    // Vertex 2 moves from (1, 1, 0) to (0, 0, 0.5): its bytes stand in the padding made longer.
    const std::string binary = square_binary() + testing::bytes_of<std::uint32_t>({2}) +
                               testing::bytes_of<float>({0, 0, 0.5F});
    std::string json = changed_json(
        "\"count\": 4, \"type\": \"VEC3\"}",
        "\"count\": 4, \"type\": \"VEC3\", \"sparse\": {\"count\": 1, \"indices\": "
        "{\"bufferView\": 3, \"componentType\": 5125}, \"values\": {\"bufferView\": 4}}}");
    json = replaced(json, "\"byteLength\": 112}", "\"byteLength\": 128}");
    const std::string views =
        "\"byteLength\": 12},\n    {\"buffer\": 0, \"byteOffset\": 112, \"byteLength\": 4},\n"
        "    {\"buffer\": 0, \"byteOffset\": 116, \"byteLength\": 12}";
    json = replaced(json, "\"byteLength\": 12}", views);
    EXPECT_EQ(parse(glb(json, binary)).points[2], (Vec3{0, 0, 5.5}));
    std::string wrong = binary;
    wrong[112] = 4;
    expect_refused([&] { parse(glb(json, wrong)); }, "t.glb", "found the index 4");
}

TEST(Gltf, QuantisedPositionsAreFractions) {
    const std::string binary =
        testing::bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0});
    const Scene scene = parse(glb(R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
        "extensionsRequired":["KHR_mesh_quantization"],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5123,"normalized":true,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":24,"byteStride":8}],
        "buffers":[{"byteLength":24}]})",
                                  binary));
    EXPECT_EQ(scene.points[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(scene.points[2], (Vec3{0, 1, 0}));
}

TEST(Gltf, WhatHasNoMaterialIsHalfGreyAndSaysSo) {
    const Scene scene = parse(changed(", \"material\": 0", ""));
    EXPECT_EQ(scene.material(scene.polygons[0]).reflectance, Spectrum(3, 0.5));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].what.find("without a material"), std::string::npos);
}

TEST(Gltf, ReflectanceOfOneIsLimitedWithOneWarning) {
    const Folder folder;
    const auto file = folder.write("white.glb", changed("[0.1, 0.2, 0.3, 1]", "[1, 0.2, 0.99, 1]"));
    const Scene scene = read_scene(file);
    EXPECT_EQ(scene.materials[0].reflectance, (Spectrum{0.98, 0.2, 0.98}));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].what.find("'glow'"), std::string::npos);
}

TEST(Gltf, DamagedImagesDoNotKeepARoomFromBeingRead) {
    expect_square(
        parse(changed("\"scene\": 0,", "\"scene\": 0, \"images\": [{\"bufferView\": 999}, 7],")));
}

TEST(Gltf, ErrorsNameThePlaceInTheText) {
    const Folder folder;
    folder.write("square data.bin", square_binary());
    const auto refused = [&](const std::string& from, const std::string& to,
                             const std::string& place, const std::string& words) {
        const auto file = folder.write("t.gltf", replaced(square_gltf(), from, to));
        expect_refused([&] { read_gltf(file); }, file.string() + place, words);
    };
    refused("\"version\": \"2.0\"", "\"version\": \"1.0\"", ":2:24", "expected a glTF version 2.x");
    refused("\"scene\": 0,", "\"scene\": 0,,", ":4:14", "not JSON");
    refused("\"scene\": 0", "\"scene\": 1e999", ":4:12", "not JSON");
    refused("\"scene\": 0", "\"scene\": 3", ":4:12",
            "scene: found '3', expected an index of scenes");
    refused("\"scene\": 0", "\"scene\": -1", ":4:12", "found '-1'");
    refused("\"nodes\": [0, 2]", "\"nodes\": [0, 9]", ":5:28", "scenes[0].nodes[1]: found '9'");
    refused("\"children\": [1]", "\"children\": [0]", ":7:5", "nodes[0]: is reached twice");
    refused("[2, 3, 1]", "[2, 3]", ":8:26", "an array of 3 numbers");
    refused("[2, 3, 1]", "[2, 3, \"x\"]", ":8:33", "nodes[1].scale[2]");
    refused("0.7853981633974483", "0", ":12:14", "an angle in radians");
    refused("[0.1, 0.2, 0.3, 1]", "[0.1, 1.2, 0.3, 1]", ":14:55", "found '1.2'");
    refused("[0.1, 0.2, 0.3, 1]", "[0.1, -0.2, 0.3, 1]", ":14:55", "found '-0.2'");
    refused("[1, 0.5, 0.25]", "[1, null, 0.25]", ":15:27", "found 'null'");
    refused("\"emissiveStrength\": 10", "\"emissiveStrength\": -1", ":16:76", "0 or more");
    refused("\"POSITION\": 0", "\"POSITION\": 3", ":18:33", "an index of accessors, 0 to 2");
    refused("\"POSITION\": 0", "\"PASITION\": 0", ":18:20", "'POSITION' is missing");
    refused("\"count\": 4", "\"count\": 4294967295", ":20:55", "found '4294967295'");
    refused("\"count\": 4", "\"count\": 4000000000", ":20:5", "4000000000 elements reach to byte");
    refused("\"count\": 4", "\"count\": -4", ":20:55", "found '-4'");
    refused("5126", "5124", ":20:40", "a component type");
    refused("\"VEC3\"", "\"VEC33\"", ":20:66", "did you mean 'VEC3'?");
    refused("\"count\": 6", "\"count\": 5", ":18:5", "a multiple of three");
    refused("\"byteOffset\": 48", "\"byteOffset\": 111", ":26:5", "of a buffer of 112 bytes");
    refused("\"byteOffset\": 0", "\"byteStride\": 8", ":20:5", "8 bytes apart");
    refused("\"byteLength\": 112", "\"byteLength\": 113", ":1:1", "113");
    refused("\"extensionsUsed\"", "\"extensionsRequired\": [\"KHR_texture_basisu\"], \"x\"",
            ":3:26", "'\"KHR_texture_basisu\"'");
}

TEST(Gltf, IndicesBeyondTheVerticesAreRefused) {
    std::string binary = square_binary();
    binary[96 + 4] = 4;
    expect_refused([&] { parse(glb(square_json(R"({"byteLength": 112})"), binary)); }, "t.glb",
                   "meshes[0].primitives[0].indices: found the index 4");
}

TEST(Gltf, PositionsThatAreNoNumbersAreRefused) {
    const Folder folder;
    std::string binary = square_binary();
    binary.replace(0, 4, testing::bytes_of<float>({std::nanf("")}));
    const auto file = folder.write("nan.glb", glb(square_json(R"({"byteLength": 112})"), binary));
    expect_refused([&] { read_scene(file); }, file.string(), "found the coordinate nan");
}

TEST(Gltf, EveryTruncationIsRefused) {
    const std::string whole = square_glb();
    for (std::size_t n = 0; n < whole.size(); ++n)
        EXPECT_THROW(parse(whole.substr(0, n)), Error) << n;
    const std::string text = square_gltf();
    for (std::size_t n = 0; n + 2 < text.size(); ++n)
        expect_sound([&] { EXPECT_TRUE(parse(text.substr(0, n)).polygons.empty()); }, "t.glb",
                     true);
}

TEST(Gltf, DeepNestingAndAbsurdCountsDoNotHurt) {
    const std::string deep(1'000'000, '[');
    EXPECT_TRUE(testing::sound_within(64, [&] { parse(R"({"asset": )" + deep); }));
    expect_refused([&] { parse(R"({"asset": )" + deep); }, "t.glb:1:74", "nested deeper");
    EXPECT_TRUE(testing::sound_within(
        32, [] { parse(changed("\"byteLength\": 112", "\"byteLength\": 2147483647")); }));
    EXPECT_TRUE(
        testing::sound_within(32, [] { parse(changed("\"count\": 4", "\"count\": 4294967294")); }));
}

RC_GTEST_PROP(Gltf, AnyMutationOfTheBytesIsReadOrRefused, ()) {
    std::string bytes = square_glb();
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i)
        bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
    expect_sound([&] { parse(bytes); }, "t.glb", false);
}

RC_GTEST_PROP(Gltf, AnyMutationOfANumberIsReadOrRefused, ()) {
    static const std::vector<std::string> values{"0",  "1",    "2",    "-1",         "4294967295",
                                                 "4",  "1e99", "null", "2147483647", "0.5",
                                                 "[]", "{}",   "\"\"", "5121",       "true"};
    std::string json = square_json(R"({"byteLength": 112})");
    std::vector<std::size_t> digits;
    for (std::size_t i = 0; i < json.size(); ++i)
        if (json[i] >= '0' && json[i] <= '9') digits.push_back(i);
    const std::size_t at = *rc::gen::elementOf(digits);
    json.replace(at, 1, *rc::gen::elementOf(values));
    expect_sound([&] { parse(glb(json, square_binary())); }, "t.glb", false);
}

// What the files hold was counted in their JSON: the index accessors of the first mesh's
// primitives.
TEST(Gltf, RealRoomsAreRead) {
    const auto room = testing::beside_project("godot/living_room.glb");
    const auto house = testing::beside_project("godot/zdm2.glb");
    if (!room || !house) GTEST_SKIP() << "the real scenes do not lie beside the project";
    const Scene living = read_scene(*room);
    EXPECT_EQ(living.materials.size(), 7U);
    EXPECT_EQ(living.surfaces.size(), 7U);
    EXPECT_EQ(living.materials[0].name, "wall");
    EXPECT_NEAR(living.materials[0].reflectance[0], 0.42002, 1e-5);
    EXPECT_TRUE(living.materials[0].two_sided);
    EXPECT_EQ(living.polygons.size(), 1539U);
    const Scene zdm = read_scene(*house);
    EXPECT_EQ(zdm.polygons.size(), 57619U);
    EXPECT_EQ(zdm.materials.size(), 1U);  // the file has none
}

}  // namespace
}  // namespace exitance
