// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

double linear(int byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// Grey texels, row by row.
TexturePicture grey(std::uint32_t width, std::uint32_t height, std::vector<int> values) {
    TexturePicture out{width, height, {}};
    for (const int v : values) out.rgb.insert(out.rgb.end(), 3, static_cast<std::uint8_t>(v));
    return out;
}

TexturePicture checker(std::uint32_t n) {
    TexturePicture out{n, n, {}};
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            out.rgb.insert(out.rgb.end(), 3, (i + j) % 2 ? 255 : 0);
    return out;
}

TEST(Texture, ValuesAreLinearAndTexelsHaveTheirPlace) {
    const Texture t(grey(2, 2, {0, 64, 128, 255}), {{}, {}, true});
    EXPECT_NEAR(t.at({0.25f, 0.25f}).x, 0, 1e-7);
    EXPECT_NEAR(t.at({0.75f, 0.25f}).y, linear(64), 1e-7);
    EXPECT_NEAR(t.at({0.25f, 0.75f}).z, linear(128), 1e-7);
    EXPECT_NEAR(t.at({0.75f, 0.75f}).x, 1, 1e-7);
    // Between the middles of texels light goes over linearly.
    const Texture smooth(grey(2, 1, {0, 255}), {TextureWrap::clamp, TextureWrap::clamp, false});
    EXPECT_NEAR(smooth.at({0.5f, 0.5f}).x, 0.5, 1e-6);
    EXPECT_NEAR(smooth.at({0.375f, 0.5f}).x, 0.25, 1e-6);
}

TEST(Texture, WrapsAsItsSamplerSays) {
    const auto at = [](TextureWrap wrap, float u) {
        return Texture(grey(2, 1, {0, 255}), {wrap, TextureWrap::repeat, true}).at({u, 0.5f}).x;
    };
    EXPECT_EQ(at(TextureWrap::repeat, 1.25f), 0);
    EXPECT_EQ(at(TextureWrap::repeat, -0.25f), 1);
    EXPECT_EQ(at(TextureWrap::mirror, 1.25f), 1);
    EXPECT_EQ(at(TextureWrap::mirror, -0.25f), 0);
    EXPECT_EQ(at(TextureWrap::clamp, 1.25f), 1);
    EXPECT_EQ(at(TextureWrap::clamp, -7), 0);
    EXPECT_EQ(at(TextureWrap::repeat, std::nanf("")), 0);
}

TEST(Texture, ThePyramidKeepsTheMeanOfAnySize) {
    for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 1u}, {5u, 7u}, {64u, 3u}, {33u, 17u}}) {
        std::vector<int> values;
        double mean = 0;
        for (std::uint32_t i = 0; i < w * h; ++i) {
            values.push_back(static_cast<int>(i * 97 % 256));
            mean += linear(values.back()) / (w * h);
        }
        // Half a step of 1/65535 per level.
        EXPECT_NEAR(Texture(grey(w, h, values), {}).mean().x, mean, 8 * 0.5 / 65535) << w << h;
    }
}

TEST(Texture, MeansOverPartsAreThoseOfTheirTexels) {
    const Texture t(grey(4, 1, {0, 255, 255, 0}), {TextureWrap::clamp, TextureWrap::clamp, true});
    const auto box = [&](float a, float b) {
        const std::array<TexturePoint, 4> corners{{{a, 0}, {b, 0}, {b, 1}, {a, 1}}};
        return t.mean(corners).x;
    };
    // A part of an element may lie in the wrong texel: 1/16 of the width at each edge.
    EXPECT_NEAR(box(0, 0.25f), 0, 1e-6);
    EXPECT_NEAR(box(0.25f, 0.75f), 1, 1e-6);
    EXPECT_NEAR(box(0, 1), 0.5, 0.02);
    // Far more texels than parts: the pyramid brings them all in.
    const Texture fine(checker(256), {});
    const std::array<TexturePoint, 3> triangle{{{0.1f, 0.1f}, {0.9f, 0.2f}, {0.4f, 0.8f}}};
    EXPECT_NEAR(fine.mean(triangle).x, 0.5, 0.005);
    const std::array<TexturePoint, 3> nothing{{{0.1f, 0.1f}, {0.1f, 0.1f}, {0.1f, 0.1f}}};
    EXPECT_LE(fine.mean(nothing).x, 1);
}

TEST(Texture, NothingIsBrighterThanItsLimit) {
    const Texture t(checker(2), {{}, {}, true}, 0.98);
    EXPECT_NEAR(t.at({0.75f, 0.25f}).x, 0.98, 1e-7);
    EXPECT_NEAR(t.mean().x, 0.49, 1e-4);
}

}  // namespace
}  // namespace exitance
