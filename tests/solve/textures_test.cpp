// SPDX-License-Identifier: Apache-2.0
// A rug with a chequered texture is the rug made of coloured squares.
#include <gtest/gtest.h>

#include <unistd.h>
#include <cmath>
#include <filesystem>

#include "exitance/pipeline.h"
#include "exitance/render/render.h"
#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/mend.h"
#include "exitance/solution/file.h"
#include "exitance/solution/probe.h"
#include "formats/gltf_builder.h"

namespace exitance {
namespace {

using testing::GltfBuilder;
using testing::Json;
using testing::Rgb;

constexpr std::uint32_t squares = 4;
const Rgb red{230, 60, 30}, blue{20, 40, 200};

double linear(int byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

Json coloured(const std::vector<double>& rgb) {
    return {{"name", "plain"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {rgb[0], rgb[1], rgb[2], 1}}}}};
}

std::vector<GltfBuilder::Sheet> inside_of_box(float x, float y, float z) {
    return {{{0, 0, 0}, {0, 0, z}, {x, 0, 0}}, {{0, y, 0}, {x, 0, 0}, {0, 0, z}},
            {{0, 0, 0}, {x, 0, 0}, {0, y, 0}}, {{0, 0, z}, {0, y, 0}, {x, 0, 0}},
            {{0, 0, 0}, {0, y, 0}, {0, 0, z}}, {{x, 0, 0}, {0, 0, z}, {0, y, 0}}};
}

/// A room of 4 × 3 × 4 m with a lamp under the ceiling; the rug is still missing.
GltfBuilder room() {
    GltfBuilder gltf;
    gltf.add_sheets(inside_of_box(4, 3, 4), gltf.add_material(coloured({0.6, 0.6, 0.6})));
    Json lamp = coloured({0, 0, 0});
    lamp["emissiveFactor"] = {1, 1, 1};
    gltf.add_sheets({{{1.5, 2.9f, 1.5}, {1, 0, 0}, {0, 0, 1}}}, gltf.add_material(lamp));
    return gltf;
}

Scene with_texture() {
    GltfBuilder gltf = room();
    std::vector<Rgb> texels;
    for (std::uint32_t j = 0; j < squares; ++j)
        for (std::uint32_t i = 0; i < squares; ++i) texels.push_back((i + j) % 2 ? blue : red);
    const std::size_t texture =
        gltf.add_texture(encode_png(testing::picture(squares, squares, texels)));
    gltf.add_sheets({{{0.5, 0.01f, 0.5}, {0, 0, 3}, {3, 0, 0}}},
                    gltf.add_material(testing::textured(texture)));
    return parse_gltf("t.glb", gltf.bytes());
}

Scene of_polygons() {
    GltfBuilder gltf = room();
    constexpr float side = 3.0f / squares;
    for (const std::uint32_t odd : {0u, 1u}) {
        std::vector<GltfBuilder::Sheet> sheets;
        for (std::uint32_t j = 0; j < squares; ++j)
            for (std::uint32_t i = 0; i < squares; ++i)
                if ((i + j) % 2 == odd)
                    sheets.push_back({{0.5f + side * float(j), 0.01f, 0.5f + side * float(i)},
                                      {0, 0, side},
                                      {side, 0, 0}});
        const Rgb& colour = odd ? blue : red;
        gltf.add_sheets(
            sheets,
            gltf.add_material(coloured({linear(colour[0]), linear(colour[1]), linear(colour[2])})));
    }
    return parse_gltf("t.glb", gltf.bytes());
}

Solution solved(Scene scene) {
    mend(scene);
    SolveOptions options;
    options.error = 0.005;  // to meet the 1 % of the test
    return light(scene, options);
}

Image picture_of(const Solution& solution) {
    Camera camera;
    camera.eye = {2, 2.5, 3.9};
    camera.look_at = {2, 0, 1.7};
    camera.fov_y = 65;
    return render_radiance(Surfaces(solution, Backs::open), camera, {64, 48}, {.samples = 64});
}

class ChequeredRug : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        texture_ = new Solution(solved(with_texture()));
        polygons_ = new Solution(solved(of_polygons()));
    }
    static void TearDownTestSuite() {
        delete texture_;
        delete polygons_;
    }
    static Solution *texture_, *polygons_;
};
Solution* ChequeredRug::texture_ = nullptr;
Solution* ChequeredRug::polygons_ = nullptr;

TEST_F(ChequeredRug, BouncesItsMeanColour) {
    // Under the ceiling beside the lamp and on two walls, what the rug sends counts most.
    const std::vector<GatherPoint> points{{{0.7, 3, 2}, {0, -1, 0}},
                                          {{3.3, 3, 2.6}, {0, -1, 0}},
                                          {{0, 0.8, 2}, {1, 0, 0}},
                                          {{2.1, 0.5, 0}, {0, 0, 1}}};
    const auto a = probe(*texture_, points), b = probe(*polygons_, points);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.01 * b[i]) << i;
    EXPECT_GT(a[0], 1.02 * a[1]);  // more red than green arrives at the ceiling
    EXPECT_LT(std::abs(texture_->energy.imbalance()), 0.01);
    ASSERT_TRUE(texture_->error);
    EXPECT_LT(texture_->error->rms, 0.05);
}

TEST_F(ChequeredRug, ShowsItsPattern) {
    const Image a = picture_of(*texture_), b = picture_of(*polygons_);
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            difference += double(std::abs(a.pixels[i][c] - b.pixels[i][c]));
            sum += double(b.pixels[i][c]);
        }
    EXPECT_LT(difference, 0.01 * sum);
    // From a red square of the rug to a blue one.
    float brightest = 0;
    for (const Vec3f& pixel : a.pixels) brightest = std::max(brightest, pixel.x / pixel.z);
    EXPECT_GT(brightest, 20.0f);
}

TEST_F(ChequeredRug, KeepsItsPatternInTheFile) {
    const auto file = std::filesystem::temp_directory_path() /
                      ("exitance-rug-" + std::to_string(::getpid()) + ".glb");
    write_solution(*texture_, file);
    const Solution again = read_solution(file);
    std::filesystem::remove(file);
    ASSERT_EQ(again.texture_coordinates.size(), again.positions.size());
    const Image a = picture_of(*texture_), b = picture_of(again);
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(a.pixels[i][c], b.pixels[i][c], 1e-5f * a.pixels[i][c] + 1e-7f);
}

// A lamp whose left half shines, twice as bright as the mean: as much light as from that half.
TEST(EmissiveTexture, SendsTheFluxOfItsPattern) {
    GltfBuilder gltf;
    gltf.add_sheets(inside_of_box(1, 1, 1), gltf.add_material(coloured({0, 0, 0})));
    Json lamp = coloured({0, 0, 0});
    lamp["emissiveFactor"] = {1, 1, 1};
    lamp["emissiveTexture"]["index"] =
        gltf.add_texture(encode_png(testing::picture(8, 1,
                                                     {{255, 255, 255},
                                                      {255, 255, 255},
                                                      {255, 255, 255},
                                                      {255, 255, 255},
                                                      {0, 0, 0},
                                                      {0, 0, 0},
                                                      {0, 0, 0},
                                                      {0, 0, 0}})));
    gltf.add_sheets({{{0.3f, 0.9f, 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}}}, gltf.add_material(lamp));
    const Solution s = solved(parse_gltf("t.glb", gltf.bytes()));
    const double flux = std::acos(-1.0) * 0.4 * 0.2;
    EXPECT_NEAR(s.energy.emitted, flux, 0.005 * flux);
    // All that is sent is absorbed by the black box, as far as its mesh tells, at 5 %, of the light
    // right above the lamp's edge.
    EXPECT_NEAR(s.energy.absorbed + s.energy.absorbed_behind, s.energy.emitted,
                0.02 * s.energy.emitted);
    // Seen from below, the left half alone shines.
    Camera camera;
    camera.eye = {0.5, 0.3, 0.5};
    camera.look_at = {0.5, 0.9, 0.5};
    camera.up = {0, 0, 1};
    camera.fov_y = 30;
    const Image image = render_radiance(Surfaces(s, Backs::open), camera, {16, 16}, {});
    EXPECT_NEAR(std::max(image.at(3, 8).x, image.at(12, 8).x), 1, 1e-3);
    EXPECT_EQ(std::min(image.at(3, 8).x, image.at(12, 8).x), 0);
}

}  // namespace
}  // namespace exitance
