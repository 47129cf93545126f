// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/colour_temperature.h"

#include <gtest/gtest.h>

namespace exitance {
namespace {

// CIE x, y of linear Rec. 709 RGB.
std::pair<double, double> chromaticity(const Spectrum& c) {
    const double X = 0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2];
    const double Y = 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2];
    const double Z = 0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2];
    return {X / (X + Y + Z), Y / (X + Y + Z)};
}

TEST(ColourTemperature, HasTheChromaticityOfTheLocus) {
    struct Row {
        double kelvin, x, y;
    };
    // Black body: integrals of Planck's law over the CIE 1931 observer. Daylight: CIE D50, D65.
    for (const Row& row :
         {Row{2000, 0.5267, 0.4133}, Row{2856, 0.4476, 0.4074}, Row{4000, 0.3805, 0.3768},
          Row{5003, 0.3457, 0.3585}, Row{6504, 0.3127, 0.3290}, Row{7504, 0.2990, 0.3149}}) {
        const auto [x, y] = chromaticity(colour_of_temperature(row.kelvin));
        EXPECT_NEAR(x, row.x, 5e-4) << row.kelvin << " K";
        EXPECT_NEAR(y, row.y, 5e-4) << row.kelvin << " K";
    }
}

TEST(ColourTemperature, HasLuminanceOneAndNoNegativeBand) {
    for (double kelvin = warmest_light; kelvin <= coolest_light; kelvin *= 1.1) {
        const Spectrum c = colour_of_temperature(kelvin);
        EXPECT_NEAR(luminance(c), 1, 1e-12);
        for (const double band : c) EXPECT_GE(band, 0);
    }
    EXPECT_NEAR(colour_of_temperature(6504)[0], 1, 2e-3) << "D65 is white";
    EXPECT_NEAR(colour_of_temperature(6504)[2], 1, 2e-3);
    EXPECT_GT(colour_of_temperature(2700)[0], 2 * colour_of_temperature(2700)[2]);
}

}  // namespace
}  // namespace exitance
