// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <numbers>

#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/read.h"
#include "exitance/scene/texture_map.h"
#include "formats/gltf_builder.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;
using testing::GltfBuilder;
using testing::Json;
using testing::picture;
using testing::textured;

constexpr double pi = std::numbers::pi;
constexpr GltfBuilder::Sheet unit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// Red and green above, blue and white below.
std::string four_colours() {
    return encode_png(picture(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}));
}

/// Reflectance of the first polygon's surface at a place.
Vec3 reflectance_at(const Scene& scene, const Vec3& place) {
    const Polygon& polygon = scene.polygons[0];
    return scene.material(polygon).reflectance_pattern.at(reflectance_map(scene, polygon)(place));
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

/// White reflects 0.98, with which light dies out.
void expect_four_colours(const Scene& scene) {
    ASSERT_TRUE(scene.materials[0].reflectance_pattern);
    expect_near(reflectance_at(scene, {0.25, 0.25, 0}), {0.98, 0, 0}, 1e-6);
    expect_near(reflectance_at(scene, {0.75, 0.25, 0}), {0, 0.98, 0}, 1e-6);
    expect_near(reflectance_at(scene, {0.25, 0.75, 0}), {0, 0, 0.98}, 1e-6);
    expect_near(reflectance_at(scene, {0.75, 0.75, 0}), {0.98, 0.98, 0.98}, 1e-6);
    for (const double rho : scene.materials[0].reflectance) EXPECT_NEAR(rho, 0.49, 0.005);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfTextures, AreReadFromBufferViewsDataUrisAndFiles) {
    GltfBuilder inside;
    inside.add_sheets({unit}, inside.add_material(textured(inside.add_texture(four_colours()))));
    expect_four_colours(parse_gltf("t.glb", inside.bytes()));

    const Folder folder;
    folder.write("four colours.png", four_colours());
    GltfBuilder outside = inside;
    outside.json["images"][0] = {{"uri", "four%20colours.png"}};
    expect_four_colours(read_scene(folder.write("t.glb", outside.bytes())));

    GltfBuilder text = inside;
    // The same four texels as a PNG of 76 bytes, in base64.
    const std::string png = four_colours();
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    for (std::size_t i = 0; i < png.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < png.size() ? static_cast<unsigned char>(png[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            base64 += i + k > png.size() ? '=' : digits[bits >> (18 - 6 * k) & 63U];
    }
    text.json["images"][0] = {{"uri", "data:image/png;base64," + base64}};
    expect_four_colours(parse_gltf("t.glb", text.bytes()));
}

TEST(GltfTextures, JpegsAreRead) {
    const TexturePicture grey = picture(16, 16, std::vector<testing::Rgb>(256, {188, 188, 188}));
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const tjhandle encoder = tjInitCompress();
    ASSERT_EQ(tjCompress2(encoder, grey.rgb.data(), 16, 0, 16, TJPF_RGB, &bytes, &size, TJSAMP_444,
                          95, 0),
              0);
    GltfBuilder gltf;
    const std::string image(reinterpret_cast<char*>(bytes), size);
    tjFree(bytes);
    tjDestroy(encoder);
    gltf.add_sheets({unit}, gltf.add_material(textured(gltf.add_texture(image))));
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    // sRGB 188 is half of white; one step of the encoded byte is 1.1 %.
    EXPECT_NEAR(scene.materials[0].reflectance[0], 0.5028, 0.012);
}

TEST(GltfTextures, TransformsScaleTurnAndMove) {
    GltfBuilder gltf;
    Json material = textured(gltf.add_texture(four_colours()));
    Json& info = material["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0, 1}}, {"rotation", pi / 2}, {"scale", {2, 1}}};
    gltf.add_sheets({unit}, gltf.add_material(material));
    // (u, v) → (2u, v) → turned by 90° counter-clockwise with v down (v, −2u) → (v, 1 − 2u).
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    expect_near(reflectance_at(scene, {0.1, 0.25, 0}), {0, 0, 0.98}, 1e-6);  // at (0.25, 0.8)
    expect_near(reflectance_at(scene, {0.4, 0.25, 0}), {0.98, 0, 0}, 1e-6);  // at (0.25, 0.2)
    expect_near(reflectance_at(scene, {0.4, 0.75, 0}), {0, 0.98, 0}, 1e-6);  // at (0.75, 0.2)
    expect_near(reflectance_at(scene, {0.6, 0.25, 0}), {0, 0, 0.98}, 1e-6);  // at (0.25, −0.2)
}

TEST(GltfTextures, TheFactorMultipliesAndColoursTint) {
    GltfBuilder gltf;
    Json material = textured(gltf.add_texture(four_colours()));
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 1};
    Json& primitive = gltf.add_sheets({unit}, gltf.add_material(material));
    primitive["attributes"]["COLOR_0"] = gltf.accessor<float>(
        {1, 0.5, 0.2f, 1, 0, 0.5, 0.2f, 1, 1, 0.5, 0.2f, 1, 0, 0.5, 0.2f, 1}, 5126, "VEC4", 4);
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    ASSERT_EQ(scene.materials.size(), 2U);  // the tinted one besides the file's own
    // Mean colour of both triangles: corners 1 0 1 and 1 1 0 of red.
    expect_near(reflectance_at(scene, {0.75, 0.75, 0}),
                {0.98 * 0.5 * 2 / 3, 0.98 * 0.25 * 0.5, 0.98 * 0.2}, 1e-3);
}

TEST(GltfTextures, EmissionIsThatOfTheTextureOnTheSurface) {
    GltfBuilder gltf;
    Json material{{"emissiveFactor", {1, 1, 1}},
                  {"emissiveTexture", {{"index", gltf.add_texture(four_colours())}}}};
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 100;
    const std::size_t glow = gltf.add_material(material);
    gltf.add_sheets({unit}, glow);
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    // Each triangle has half of the blue or green square, both halves of the others.
    for (const double e : scene.materials[0].exitance) EXPECT_NEAR(e, 100 * pi / 2, 1.0);
    double flux = 0;
    for (const Polygon& polygon : scene.polygons)
        flux += scene.area(polygon) * luminance(mean_exitance(scene, polygon));
    EXPECT_NEAR(flux, luminance(scene.materials[0].exitance), 1e-6 * flux);
}

TEST(GltfTextures, WhatCannotBeReadIsToldAndHalfGrey) {
    const auto read = [](const Json& image) {
        GltfBuilder gltf;
        gltf.add_sheets({unit}, gltf.add_material(textured(gltf.add_texture(four_colours()))));
        if (!image.is_null()) gltf.json["images"][0] = image;
        return parse_gltf("t.glb", gltf.bytes());
    };
    for (const Json& image :
         {Json{{"uri", "there is none.png"}}, Json{{"uri", "../../../../etc/passwd"}},
          Json{{"uri", "/etc/passwd"}}, Json{{"uri", "data:image/png;base64,AAAA"}},
          Json{{"bufferView", 1}}, Json{{"bufferView", 999}}, Json{{"name", "none"}}}) {
        const Scene scene = read(image);
        EXPECT_EQ(scene.materials[0].reflectance, (Spectrum{0.5, 0.5, 0.5})) << image;
        ASSERT_EQ(scene.warnings.size(), 1U) << image;
        EXPECT_NE(scene.warnings[0].what.find("its texture cannot be read"), std::string::npos);
    }
}

TEST(GltfTextures, LimitsAreNamedWithTheirOption) {
    GltfBuilder gltf;
    gltf.add_sheets({unit}, gltf.add_material(textured(gltf.add_texture(four_colours()))));
    ReadOptions options;
    options.max_texture_pixels = 3;
    expect_refused([&] { parse_gltf("t.glb", gltf.bytes(), options); }, "t.glb",
                   "--max-texture-pixels raises the limit");
    options = {};
    options.max_polygons = 1;
    expect_refused([&] { parse_gltf("t.glb", gltf.bytes(), options); }, "t.glb",
                   "--max-polygons raises the limit");
}

TEST(GltfTextures, GlassAndGlossHaveTheirShares) {
    GltfBuilder gltf;
    Json glass{{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.6, 0.4, 1}}}}};
    glass["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.75;
    glass["extensions"]["KHR_materials_ior"]["ior"] = 2;
    glass["extensions"]["KHR_materials_specular"]["specularFactor"] = 0.5;
    gltf.add_sheets({unit}, gltf.add_material(glass));
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    const Material& m = scene.materials[0];
    expect_near({m.reflectance[0], m.reflectance[1], m.reflectance[2]}, {0.2, 0.15, 0.1}, 1e-12);
    expect_near({m.transmittance[0], m.transmittance[1], m.transmittance[2]}, {0.6, 0.45, 0.3},
                1e-12);
    EXPECT_EQ(m.refractive_index, 2);
    EXPECT_NEAR(m.specular[0], 0.5 / 9, 1e-12);  // ((2 − 1) / (2 + 1))² / 2
}

TEST(GltfTextures, WhatIsReadInPartIsTold) {
    GltfBuilder gltf;
    Json material{{"name", "leaf"}, {"alphaMode", "MASK"}};
    material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0.8, 0.6, 0.2, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0.1}};
    Json& sheet = gltf.add_sheets({unit}, gltf.add_material(material));
    sheet["targets"] = {{{"POSITION", sheet["attributes"]["POSITION"]}}};
    Json line = sheet;
    line["mode"] = 1;
    gltf.json["meshes"][0]["primitives"].push_back(line);
    gltf.json["skins"] = {{{"joints", {0}}}};
    gltf.json["nodes"][0]["skin"] = 0;
    gltf.json["cameras"] = {
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}}};
    gltf.json["nodes"][0]["camera"] = 0;
    const Scene scene = parse_gltf("t.glb", gltf.bytes());
    EXPECT_EQ(scene.polygons.size(), 2U);
    EXPECT_TRUE(scene.cameras.empty());
    // A metal reflects its base colour, diffusely.
    EXPECT_NEAR(scene.materials[0].reflectance[0], 0.8, 1e-6);
    EXPECT_NEAR(scene.materials[0].reflectance[2], 0.2, 1e-6);
    for (const char* words : {"is cut out by its texture", "points or lines are left out",
                              "skinned nodes", "morph targets", "without a perspective"})
        EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                                [&](const Problem& problem) {
                                    return problem.what.find(words) != std::string::npos;
                                }),
                  1)
            << words;
}

}  // namespace
}  // namespace exitance
