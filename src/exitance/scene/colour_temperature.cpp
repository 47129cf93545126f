// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/colour_temperature.h"

#include <algorithm>
#include <array>

namespace exitance {

namespace {

using Chromaticity = std::array<double, 2>;  // CIE 1931 x, y

// Krystek 1985, "An algorithm to calculate correlated colour temperature": u, v of CIE 1960 within
// 9e-5 from 1000 to 15000 K.
Chromaticity black_body(double t) {
    const double u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
                     (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    const double v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
                     (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
    const double w = 2 * u - 8 * v + 4;
    return {3 * u / w, 2 * v / w};
}

// CIE 15:2004, section 3.1.
Chromaticity daylight(double t) {
    const double r = 1e3 / t;
    const double x = t <= 7000 ? ((-4.6070 * r + 2.9678) * r + 0.09911) * r + 0.244063
                               : ((-2.0064 * r + 1.9018) * r + 0.24748) * r + 0.237040;
    return {x, (-3.000 * x + 2.870) * x - 0.275};
}

}  // namespace

Spectrum colour_of_temperature(double kelvin) {
    const auto [x, y] = kelvin < 5000 ? black_body(kelvin) : daylight(kelvin);
    const double X = x / y, Z = (1 - x - y) / y;
    // From XYZ with Y = 1 to the primaries of Rec. ITU-R BT.709 with white D65.
    Spectrum rgb{3.2404542 * X - 1.5371385 - 0.4985314 * Z,
                 -0.9692660 * X + 1.8760108 + 0.0415560 * Z,
                 0.0556434 * X - 0.2040259 + 1.0572252 * Z};
    for (double& band : rgb) band = std::max(0.0, band);
    const double level = luminance(rgb);
    for (double& band : rgb) band /= level;
    return rgb;
}

}  // namespace exitance
