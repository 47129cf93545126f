// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/cie_observer.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace exitance {
namespace {

void expect_chromaticity(const Xyz& xyz, double x, double y, double tolerance) {
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, x, tolerance);
    EXPECT_NEAR(xyz.y / sum, y, tolerance);
}

void expect_rgb(const Spectrum& rgb, double r, double g, double b, double tolerance) {
    ASSERT_EQ(rgb.size(), 3U);
    EXPECT_NEAR(rgb[0], r, tolerance);
    EXPECT_NEAR(rgb[1], g, tolerance);
    EXPECT_NEAR(rgb[2], b, tolerance);
}

TEST(CieObserver, EqualEnergyIsOneThird) {
    expect_chromaticity(xyz_of_spectrum({380, 780, {1, 1}}), 1 / 3.0, 1 / 3.0, 1e-12);
    EXPECT_EQ(xyz_of_spectrum({380, 780, {7, 7, 7}}).y, 1);
}

TEST(CieObserver, BlackBodiesAreOnThePlanckianLocus) {
    // CIE 15:2004: illuminant A is 2856 K (x 0.4476, y 0.4074); 6500 K is at 0.3135, 0.3237.
    expect_chromaticity(xyz_of_spectrum(black_body(2856)), 0.4476, 0.4074, 3e-4);
    expect_chromaticity(xyz_of_spectrum(black_body(6500)), 0.3135, 0.3237, 3e-4);
    expect_chromaticity(xyz_of_spectrum(black_body(1000)), 0.6528, 0.3444, 1e-3);
}

TEST(CieObserver, SpectraAreLinearInBetweenAndZeroOutside) {
    const SampledSpectrum ramp{400, 500, {0, 2, 0}};
    EXPECT_EQ(ramp.at(425), 1);
    EXPECT_EQ(ramp.at(450), 2);
    EXPECT_EQ(ramp.at(399), 0);
    EXPECT_EQ(ramp.at(501), 0);
    // Nothing that the eye sees: black.
    EXPECT_EQ(xyz_of_spectrum({800, 900, {1, 1}}), (Xyz{0, 0, 0}));
}

TEST(CieObserver, NarrowBandsAreSpectralColours) {
    // 520 nm: x̄ 0.0633, ȳ 0.7100, z̄ 0.0782.
    expect_chromaticity(xyz_of_spectrum({519.9, 520.1, {1, 1}}), 0.0743, 0.8339, 1e-3);
}

TEST(CieObserver, EqualEnergyIsWhite) {
    expect_rgb(rgb_of({1, 1, 1}), 1, 1, 1, 1e-5);
    EXPECT_NEAR(luminance(rgb_of(xyz_of_chromaticity(0.4, 0.35))), 1, 1e-12);
}

TEST(CieObserver, ColoursLeanTheRightWay) {
    const Spectrum red = rgb_of(xyz_of_chromaticity(0.5, 0.32));
    EXPECT_GT(red[0], 2 * red[1]);
    const Spectrum blue = rgb_of(xyz_of_chromaticity(0.22, 0.22));
    EXPECT_GT(blue[2], 2 * blue[0]);
    const Spectrum green = rgb_of(xyz_of_chromaticity(0.3, 0.5));
    EXPECT_GT(green[1], green[0]);
    EXPECT_GT(green[1], green[2]);
}

TEST(CieObserver, OutsideTheGamutIsPalerAndAsBright) {
    const Spectrum green = rgb_of(xyz_of_chromaticity(0, 0.38));
    EXPECT_LT(green[0], 0);
    const double share = gamut_share(green, 1e9);
    EXPECT_GT(share, 0);
    EXPECT_LT(share, 1);
    const Spectrum inside = toward_grey(green, share);
    EXPECT_NEAR(*std::min_element(inside.begin(), inside.end()), 0, 1e-12);
    EXPECT_NEAR(luminance(inside), 1, 1e-12);
    // Also from above: 0.5 in luminance with a band at 1.2 moves until that is 1.
    const Spectrum bright{0.1, 0.6, 1.2};
    const Spectrum limited = toward_grey(bright, gamut_share(bright, 1));
    EXPECT_NEAR(*std::max_element(limited.begin(), limited.end()), 1, 1e-12);
    EXPECT_NEAR(luminance(limited), luminance(bright), 1e-12);
    EXPECT_EQ(gamut_share({0.2, 0.3, 0.4}, 1), 1);
}

TEST(CieObserver, BandsAreMeans) {
    const SampledSpectrum ramp{400, 700, {0, 3}};  // 0.01 per nm
    const Spectrum bands = band_means(ramp, 400, 700, 3);
    expect_rgb(bands, 0.5, 1.5, 2.5, 1e-12);
    const Spectrum wide = band_means({380, 780, {1, 1}}, 380, 1180, 2);
    EXPECT_NEAR(wide[0], 1, 1e-12);
    EXPECT_NEAR(wide[1], 0, 1e-12);
}

}  // namespace
}  // namespace exitance
