// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/read.h"
#include "formats/gltf_builder.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;
using testing::GltfBuilder;
using testing::Json;

constexpr double pi = std::numbers::pi;

/// A node 3 m up, turned to look down (−z becomes −y), with one punctual light.
GltfBuilder with_light(const Json& light) {
    GltfBuilder gltf;
    gltf.json["nodes"] = {{{"name", "lamp"},
                           {"translation", {0, 3, 0}},
                           {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    return gltf;
}

TEST(GltfLights, PointsShineEvenlyInTheirColour) {
    const Scene scene = parse_gltf(
        "t.glb",
        with_light({{"type", "point"}, {"intensity", 200}, {"color", {1, 0.5, 0.25}}}).bytes());
    ASSERT_EQ(scene.luminaires.size(), 1U);
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    const Luminaire& lamp = scene.luminaires[0];
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.position, (Vec3{0, 3, 0}));
    const std::array<double, 3> colour{1, 0.5, 0.25};
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(lamp.intensity({0, 0, 1}) * lamp.colour[b], 200 * colour[b], 1e-9);
    EXPECT_NEAR(lamp.flux(), 4 * pi * 200 * luminance({1, 0.5, 0.25}), 1e-3 * lamp.flux());
}

TEST(GltfLights, SpotsFallBetweenTheirCones) {
    const double inner = pi / 12, outer = pi / 4;
    const Scene scene = parse_gltf(
        "t.glb", with_light({{"type", "spot"},
                             {"intensity", 1000},
                             {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}})
                     .bytes());
    ASSERT_EQ(scene.luminaires.size(), 1U);
    const Luminaire& lamp = scene.luminaires[0];
    const auto at = [&](double gamma) {
        return lamp.intensity({std::sin(gamma), -std::cos(gamma), 0});
    };
    EXPECT_NEAR(at(0), 1000, 1e-6);
    EXPECT_NEAR(at(inner * 0.9), 1000, 1e-6);
    EXPECT_NEAR(at(outer * 1.01), 0, 1e-6);
    const double share = (std::cos(pi / 6) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    EXPECT_NEAR(at(pi / 6), 1000 * share * share, 1);
    // Inside, a cap; outside, with c = cos γ: 2π ∫ ((c − o) / (i − o))² dc = 2π (i − o) / 3.
    const double i = std::cos(inner), o = std::cos(outer);
    EXPECT_NEAR(lamp.flux(), 2000 * pi * (1 - i + (i - o) / 3), 2e-3 * lamp.flux());
}

TEST(GltfLights, DirectionalOnesShineFromInfinity) {
    const Scene scene = parse_gltf(
        "t.glb",
        with_light({{"type", "directional"}, {"intensity", 50000}, {"color", {1, 0.5, 0.25}}})
            .bytes());
    EXPECT_TRUE(scene.luminaires.empty());
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    ASSERT_EQ(scene.distant.size(), 1U);
    const DistantLight& sun = scene.distant[0];
    EXPECT_EQ(sun.name, "lamp");
    EXPECT_NEAR(length(sun.direction - Vec3{0, 1, 0}), 0, 1e-12);  // it shines down
    EXPECT_EQ(sun.diameter, 0);
    const std::array<double, 3> colour{1, 0.5, 0.25};
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(sun.irradiance * sun.colour[b], 50000 * colour[b], 1e-8);
}

TEST(GltfLights, WhatHasNoMeaningIsRefused) {
    expect_refused(
        [] {
            parse_gltf("t.glb", with_light({{"type", "laser"}}).bytes());
        },
        "t.glb", "expected point, spot or directional");
    expect_refused(
        [] {
            parse_gltf("t.glb", with_light({{"type", "point"}, {"intensity", -1}}).bytes());
        },
        "t.glb", "expected an intensity");
}

TEST(GltfLights, IesLampsHangInTheirNodes) {
    // 100 cd within 60° of the axis.
    const std::string ies =
        "IESNA:LM-63-2002\r\nTILT=NONE\r\n1 -1 1 3 1 1 2 0 0 0\r\n1 1 10\r\n0 60 61\r\n0\r\n"
        "100 100 0\r\n";
    GltfBuilder gltf;
    gltf.json["nodes"] = {
        {{"name", "down"},
         {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
         {"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}}}}}},
        {{"name", "along −z"}, {"extensions", {{"EXT_lights_ies", {{"light", 1}}}}}}};
    gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
    gltf.json["extensionsRequired"] = {"EXT_lights_ies"};
    gltf.json["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"uri", "lamp.ies"}},
        {{"bufferView", gltf.view(ies)}, {"mimeType", "application/x-ies-lm-63"}}};
    const Folder folder;
    folder.write("lamp.ies", ies);
    const Scene scene = read_scene(folder.write("t.glb", gltf.bytes()));
    ASSERT_EQ(scene.luminaires.size(), 2U);
    EXPECT_NEAR(scene.luminaires[0].intensity({0, -1, 0}), 200, 1e-9);
    EXPECT_NEAR(scene.luminaires[0].intensity({0, 0, -1}), 0, 1e-9);
    EXPECT_NEAR(scene.luminaires[1].intensity({0, 0, -1}), 100, 1e-9);
    EXPECT_NEAR(scene.luminaires[1].intensity({0, -1, 0}), 0, 1e-9);
}

}  // namespace
}  // namespace exitance
