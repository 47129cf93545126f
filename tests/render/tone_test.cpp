// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/tone.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/render/false_colour.h"
#include "exitance/run/error.h"

namespace exitance {
namespace {

TEST(Tone, curves_rise_from_black_to_white) {
    for (const char* name : {"linear", "reinhard", "filmic"}) {
        const ToneCurve curve = tone_curve(name);
        EXPECT_EQ(toned({0, 0, 0}, curve, 4), Vec3f{}) << name;
        float before = 0;
        for (float v = 1e-4f; v < 100; v *= 1.05f) {
            const Vec3f shown = toned({v, v, v}, curve, 4);
            EXPECT_GE(shown.x, before) << name << " at " << v;
            EXPECT_LE(shown.x, 1) << name;
            if (shown.x < 0.99f) {
                EXPECT_GT(shown.x, before) << name << " at " << v;
            }
            before = shown.x;
        }
        EXPECT_GT(before, 0.99f) << name;
    }
    EXPECT_THROW(tone_curve("vivid"), Error);
}

TEST(Tone, values_by_hand) {
    EXPECT_FLOAT_EQ(toned({0.4f, 0.4f, 0.4f}, ToneCurve::linear, 4).y, 0.4f);
    // 1 · (1 + 1/16) / 2
    EXPECT_NEAR(toned({1, 1, 1}, ToneCurve::reinhard, 4).y, 0.53125, 1e-6);
    EXPECT_NEAR(toned({4, 4, 4}, ToneCurve::reinhard, 4).y, 1, 1e-6);
    // 1 · 2.54 / (3.02 + 0.14)
    EXPECT_NEAR(toned({1, 1, 1}, ToneCurve::filmic, 4).y, 2.54 / 3.16, 1e-6);
    EXPECT_DOUBLE_EQ(exposure_of_ev(0), 1 / 1.2);
    EXPECT_DOUBLE_EQ(exposure_of_ev(3), 1 / 9.6);
}

TEST(Tone, exposure_makes_the_average_grey) {
    Image image(10, 10);
    std::vector<float> coverage(100, 1.0f);
    for (std::size_t i = 0; i < 100; ++i) {
        const float v = i % 2 ? 20.0f : 5.0f;  // geometric mean 10
        image.pixels[i] = {v, v, v};
    }
    EXPECT_NEAR(automatic_exposure(image, coverage), 0.018, 1e-6);
    // Nothing there, nothing counted; and black pictures stay so.
    for (std::size_t i = 0; i < 50; ++i) image.pixels[2 * i] = {}, coverage[2 * i] = 0;
    EXPECT_NEAR(automatic_exposure(image, coverage), 0.009, 1e-6);
    EXPECT_EQ(automatic_exposure(Image(2, 2), std::vector<float>(4, 1.0f)), 1);
    EXPECT_EQ(automatic_exposure(Image(2, 2), std::vector<float>(4, 0.0f)), 1);
}

TEST(FalseColour, is_on_screen_and_evenly_lighter) {
    double before = -1;
    double least = 1, most = 0;
    for (int i = 0; i <= 256; ++i) {
        const Vec3f c = false_colour(i / 256.0);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GE(c[k], -1e-6f) << i;
            EXPECT_LE(c[k], 1 + 1e-6f) << i;
        }
        // CIE lightness (cube root of luminance) rises evenly: no step stands out as an edge.
        const double lightness = std::cbrt(luminance(c));
        if (i > 0) {
            least = std::min(least, lightness - before);
            most = std::max(most, lightness - before);
        }
        before = lightness;
    }
    EXPECT_GT(least, 0);
    EXPECT_LT(most, 2.2 * least);
}

TEST(FalseColour, marks_are_round) {
    EXPECT_EQ(round_marks(0, 100, 5), (std::vector<double>{0, 20, 40, 60, 80, 100}));
    EXPECT_EQ(round_marks(0, 280, 6), (std::vector<double>{0, 50, 100, 150, 200, 250}));
    EXPECT_EQ(round_marks(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
    EXPECT_EQ(round_marks(5, 5, 4), (std::vector<double>{5}));
    for (const double top : {1e-9, 0.03, 7.0, 1e12}) {
        const auto marks = round_marks(0, top, 6);
        EXPECT_GE(marks.size(), 3u);
        EXPECT_LE(marks.size(), 8u);
        EXPECT_LE(marks.back(), top * (1 + 1e-9));
    }
}

TEST(FalseColour, a_legend_fits_any_picture) {
    for (const std::uint32_t n : {1u, 20u, 64u, 240u, 900u}) {
        Image image(n, n);
        draw_legend(image, 0, 1234, "illuminance", "lx");
        const bool drawn = std::any_of(image.pixels.begin(), image.pixels.end(),
                                       [](const Vec3f& p) { return p.x > 0; });
        EXPECT_EQ(drawn, n >= 240) << n;
        EXPECT_EQ(image.at(0, 0), Vec3f{}) << n;
    }
}

}  // namespace
}  // namespace exitance
