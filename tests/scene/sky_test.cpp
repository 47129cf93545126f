// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/scene/distant_light.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

DistantLight sky_of(const SkyModel& model) {
    DistantLight light;
    light.kind = DistantLight::Kind::sky;
    light.model = model;
    return light;
}

Vec3 at(double altitude, double azimuth) {
    return {std::cos(altitude) * std::sin(azimuth), std::sin(altitude),
            -std::cos(altitude) * std::cos(azimuth)};
}

TEST(Sky, DirectionsAndPlacesAreOneToOneAndKeepAreas) {
    Vec3 sum;
    constexpr int n = 64;
    for (const bool lower : {false, true})
        for (int i = 0; i < n * n; ++i) {
            const DirectionPlace place{lower, (i % n + 0.3) / n, (i / n + 0.7) / n};
            const Vec3 d = direction_of(place);
            const DirectionPlace back = place_of(d);
            EXPECT_NEAR(length(d), 1, 1e-12);
            EXPECT_EQ(back.lower, lower);
            EXPECT_NEAR(back.u, place.u, 1e-9);
            EXPECT_NEAR(back.v, place.v, 1e-9);
            if (!lower) sum += d;
        }
    // Equal areas: the mean height over a hemisphere is 1/2 (Archimedes).
    EXPECT_NEAR(sum.y / (n * n), 0.5, 1e-3);
}

TEST(Sky, HorizontalIlluminanceOfTheClosedForms) {
    // ∫ L cosθ dω: π L of a uniform sky; 7π/9 Lz of the traditional overcast sky.
    SkyModel uniform = cie_sky(5);
    EXPECT_NEAR(horizontal_irradiance(sky_of(uniform)), pi, 1e-3 * pi);
    EXPECT_NEAR(horizontal_irradiance(sky_of(cie_sky(16))), 7 * pi / 9, 1e-3);
}

TEST(Sky, StandardSkiesHaveTheirTabulatedShape) {
    // Type 1, standard overcast: the zenith is 3 times as bright as the horizon (ISO 15469:2004,
    // φ(0) / φ(90°) = 1 + 4 exp(−0.7)).
    const SkyModel overcast = cie_sky(1);
    EXPECT_NEAR(overcast.luminance(at(pi / 2, 0)) / overcast.luminance(at(1e-3, 0)),
                1 + 4 * std::exp(-0.7), 0.01);
    // Type 12, clear: brighter at the horizon than in the zenith away from the sun, darkest a
    // quarter turn away from it, and f(χ) = 1 + 10 (e^−3χ − e^−3π/2) + 0.45 cos²χ.
    SkyModel clear = cie_sky(12);
    clear.sun = at(40 * pi / 180, 0);
    const auto f = [](double chi) {
        return 1 + 10 * (std::exp(-3 * chi) - std::exp(-3 * pi / 2)) +
               0.45 * std::cos(chi) * std::cos(chi);
    };
    const double zenith = clear.luminance({0, 1, 0}),
                 near = clear.luminance(at(40 * pi / 180, 0.2));
    const double chi = std::acos(dot(at(40 * pi / 180, 0.2), clear.sun));
    const auto phi = [](double z) { return 1 - std::exp(-0.32 / std::cos(z)); };
    EXPECT_NEAR(near / zenith, phi(50 * pi / 180) * f(chi) / (phi(0) * f(50 * pi / 180)), 1e-9);
    EXPECT_EQ(clear.luminance(at(-0.1, 0)), 0);
    for (int type = 1; type <= 15; ++type) {
        SkyModel sky = cie_sky(type);
        sky.sun = at(0.7, 1);
        for (int i = 1; i < 90; ++i)
            EXPECT_GE(sky.luminance(at(i * pi / 180, 0.3 * i)), 0) << "type " << type;
    }
}

TEST(Sky, PerezFollowsTheMeasuredConditions) {
    // Heavy overcast: no direct light, ε = 1, a sky without a bright place round the sun; clear:
    // ε above 6.2 with most light near the sun.
    const double altitude = 45 * pi / 180;
    const SkyConditions dull = sky_conditions({0, 100}, altitude, 81);
    EXPECT_NEAR(dull.clearness, 1, 1e-12);
    EXPECT_NEAR(dull.brightness, 100 * 1.4128 / (1367 * 1.0058), 2e-3) << "Δ = D m / I₀";
    const SkyConditions clear = sky_conditions({900, 80}, altitude, 172);
    EXPECT_GT(clear.clearness, 6.2);
    SkyModel sky = perez_sky(clear, altitude);
    sky.sun = at(altitude, 0);
    EXPECT_GT(sky.luminance(at(altitude, 0.1)), 5 * sky.luminance(at(altitude, pi)));
    SkyModel grey = perez_sky(dull, altitude);
    grey.sun = sky.sun;
    EXPECT_LT(grey.luminance(at(altitude, 0.1)), 2 * grey.luminance(at(altitude, pi)));
    EXPECT_GT(grey.luminance({0, 1, 0}), grey.luminance(at(0.1, 2)));
    // Efficacies of daylight lie near 100 … 140 lm/W (Perez et al. 1990, figs. 5 … 7).
    const DaylightEfficacy efficacy = daylight_efficacy(clear, altitude);
    EXPECT_NEAR(efficacy.direct, 100, 10);
    EXPECT_NEAR(efficacy.diffuse, 135, 20);
}

}  // namespace
}  // namespace exitance
