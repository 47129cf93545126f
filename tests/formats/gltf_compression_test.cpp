// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "exitance/scene/formats/gltf.h"
#include "formats/gltf_builder.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;
using testing::GltfBuilder;
using testing::Json;

/// A square of 2 × 3 in z = 0.
const std::vector<float> corners{0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0};
const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};

void expect_square(const Scene& scene) {
    ASSERT_EQ(scene.polygons.size(), 2U);
    EXPECT_NEAR(scene.area(scene.polygons[0]) + scene.area(scene.polygons[1]), 6, 1e-3);
    EXPECT_NEAR(scene.normal(scene.polygons[0]).z, 1, 1e-6);
}

GltfBuilder meshopt_square(std::size_t damaged = std::string::npos) {
    GltfBuilder gltf;
    std::string vertices(meshopt_encodeVertexBufferBound(4, 12), '\0');
    vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()),
                                               vertices.size(), corners.data(), 4, 12));
    std::string indices(meshopt_encodeIndexBufferBound(6, 4), '\0');
    indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()),
                                             indices.size(), triangles.data(), 6));
    if (damaged < vertices.size()) vertices[damaged] = static_cast<char>(vertices[damaged] ^ 0x55);
    const std::size_t from[] = {gltf.view(vertices), gltf.view(indices)};
    const Json packed = gltf.json["bufferViews"];
    gltf.json["bufferViews"] = Json::array();
    for (const bool index : {false, true}) {
        Json view{{"buffer", 1}, {"byteLength", index ? 24 : 48}};
        if (!index) view["byteStride"] = 12;
        Json& extension = view["extensions"]["EXT_meshopt_compression"] = packed[from[index]];
        extension["byteStride"] = index ? 4 : 12;
        extension["count"] = index ? 6 : 4;
        extension["mode"] = index ? "TRIANGLES" : "ATTRIBUTES";
        gltf.json["bufferViews"].push_back(view);
    }
    gltf.json["buffers"] = {
        {},
        {{"byteLength", 72}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    gltf.json["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
    gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
    gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    return gltf;
}

TEST(GltfCompression, MeshoptIsDecoded) {
    expect_square(parse_gltf("t.glb", meshopt_square().bytes()));
}

TEST(GltfCompression, AbsurdAndDamagedMeshoptIsRefused) {
    GltfBuilder absurd = meshopt_square();
    absurd.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 2000000000;
    expect_refused([&] { parse_gltf("t.glb", absurd.bytes()); }, "t.glb", "which cannot be");
    expect_refused([&] { parse_gltf("t.glb", meshopt_square(0).bytes()); }, "t.glb",
                   "its compressed data is damaged");
}

std::string draco_square() {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::uint32_t f = 0; f < 2; ++f)
        builder.SetAttributeValuesForFace(
            position, draco::FaceIndex(f), &corners[3 * triangles[3 * f]],
            &corners[3 * triangles[3 * f + 1]], &corners[3 * triangles[3 * f + 2]]);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

GltfBuilder gltf_of_draco(const std::string& bytes) {
    GltfBuilder gltf;
    const std::size_t view = gltf.view(bytes);
    gltf.json["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                              {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
    Json primitive{{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                             {"attributes", {{"POSITION", 0}}}};
    gltf.json["meshes"] = {{{"primitives", {primitive}}}};
    gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return gltf;
}

TEST(GltfCompression, DracoIsDecoded) {
    expect_square(parse_gltf("t.glb", gltf_of_draco(draco_square()).bytes()));
}

TEST(GltfCompression, AbsurdDracoIsRefusedBeforeItIsDecoded) {
    using namespace std::string_literals;
    const std::string mesh = "DRACO\x02\x02\x01"s;
    const std::string absurd = "\xff\xff\xff\xff\x07"s, three = "\x03"s, room(40, '\0');
    for (const std::string& bytes :
         {mesh + "\0\0\0"s + absurd + three + room,               // faces, sequential
          mesh + "\0\0\0"s + three + absurd + room,               // points
          mesh + "\1\0\0\0"s + absurd + three + room,             // points, edgebreaker
          mesh + "\1\0\0\0"s + three + absurd + room,             // faces
          mesh + "\1\0\x80\0\0\0\0"s + three + absurd + room}) {  // after metadata of nothing
        const std::string file = gltf_of_draco(bytes).bytes();
        expect_refused([&] { parse_gltf("t.glb", file); }, "t.glb", "which cannot be");
        EXPECT_TRUE(testing::sound_within(64, [&] { parse_gltf("t.glb", file); }));
    }
    for (const std::string& bytes : {mesh, mesh + "\1\0\0"s, mesh + "\0\0\x80\5"s})
        expect_refused([&] { parse_gltf("t.glb", gltf_of_draco(bytes).bytes()); }, "t.glb",
                       "ends in its header");
    expect_refused([&] { parse_gltf("t.glb", gltf_of_draco("DRACO\1\2"s + room).bytes()); },
                   "t.glb", "expected Draco 2.2");
}

TEST(GltfCompression, DamagedDracoIsReadOrRefused) {
    const std::string whole = draco_square();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
        expect_sound([&] { parse_gltf("t.glb", gltf_of_draco(damaged).bytes()); }, "t.glb", false);
    }
    expect_refused([&] { parse_gltf("t.glb", gltf_of_draco("no Draco").bytes()); }, "t.glb",
                   "expected Draco 2.2");
    expect_refused(
        [&] { parse_gltf("t.glb", gltf_of_draco(whole.substr(0, whole.size() / 2)).bytes()); },
        "t.glb", "cannot be decoded");
}

TEST(GltfCompression, InstancesStandWhereTheirAttributesSay) {
    GltfBuilder gltf;
    gltf.add_sheets({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, gltf.add_material({{"name", "m"}}));
    const std::size_t moves = gltf.accessor<float>({0, 0, 0, 5, 0, 0}, 5126, "VEC3", 2);
    const std::size_t scales = gltf.accessor<float>({1, 1, 1, 2, 3, 1}, 5126, "VEC3", 2);
    gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", moves}, {"SCALE", scales}};
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    ASSERT_EQ(scene.polygons.size(), 4U);
    EXPECT_NEAR(scene.area(scene.polygons[2]), 3, 1e-6);
    EXPECT_NEAR(scene.bounds().upper.x, 7, 1e-6);
}

TEST(GltfCompression, RequiredExtensionsThatAreUnknownAreNamed) {
    GltfBuilder gltf;
    gltf.add_sheets({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, gltf.add_material({{"name", "m"}}));
    gltf.json["extensionsRequired"] = {"KHR_texture_basisu"};
    expect_refused([&] { parse_gltf("t.glb", gltf.bytes()); }, "t.glb", "KHR_texture_basisu");
}

}  // namespace
}  // namespace exitance
