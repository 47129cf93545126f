// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/photometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/run/random.h"
#include "exitance/scene/builtin_photometry.h"
#include "exitance/scene/lamp_figures.h"
#include "scene/lamps.h"

namespace exitance {
namespace {

using testing::cosine_photometry;
using testing::crooked_photometry;

constexpr double pi = std::numbers::pi;

Vec3 direction(double c, double gamma) {
    const double g = gamma * pi / 180, a = c * pi / 180;
    return {std::sin(g) * std::cos(a), std::sin(g) * std::sin(a), -std::cos(g)};
}

TEST(Photometry, IntensitiesAreBilinearInTheAngles) {
    const Photometry p = crooked_photometry();
    const std::size_t n = p.gammas.size();
    // On the grid, half-way between four values, and across C = 360.
    EXPECT_NEAR(p.intensity(direction(40, 30)), p.candela[2 * n + 3], 1e-9);
    const double four =
        p.candela[2 * n + 3] + p.candela[2 * n + 4] + p.candela[3 * n + 3] + p.candela[3 * n + 4];
    EXPECT_NEAR(p.intensity(direction(50, 35)), four / 4, 1e-9);
    EXPECT_NEAR(p.at(-10, 30), 0.5 * (p.candela[17 * n + 3] + p.candela[3]), 1e-9);
    EXPECT_NEAR(p.at(370, 30), 0.5 * (p.candela[3] + p.candela[n + 3]), 1e-9);
    EXPECT_EQ(p.intensity(direction(40, 151)), 0) << "dark beyond the table";
    EXPECT_NEAR(p.intensity({0, 0, -1}), p.candela[0], 1e-9);
    EXPECT_EQ(isotropic_photometry().intensity({0, 0, 1}), 1) << "the last angle belongs to it";
    EXPECT_EQ(isotropic_photometry().intensity(normalized(Vec3{1e-17, 0, 1})), 1);
}

TEST(Photometry, FluxIsTheExactIntegralOfTheInterpolant) {
    EXPECT_NEAR(isotropic_photometry().flux(), 4 * pi, 1e-12);
    // I = γ from 0 to 180°: ∫ γ sin γ dγ = π, times 2π. One cell or many, the same.
    Photometry linear = isotropic_photometry();
    linear.candela = {0, pi};
    EXPECT_NEAR(linear.flux(), 2 * pi * pi, 1e-12);
    linear.gammas.clear(), linear.candela.clear();
    for (int i = 0; i <= 3600; ++i)
        linear.gammas.push_back(0.05 * i), linear.candela.push_back(pi * i / 3600);
    EXPECT_NEAR(linear.flux(), 2 * pi * pi, 1e-9);
    EXPECT_NEAR(linear.flux_below(), 2 * pi, 1e-9) << "∫ γ sin γ to 90° is 1";
    // Lambert's lamp: Φ = π I, up to the interpolation of the cosine.
    EXPECT_NEAR(cosine_photometry(1000).flux(), 1000 * pi, 1e-6 * 1000 * pi);
    // Brute force over a crooked one: midpoint rule, error of second order.
    const Photometry crooked = crooked_photometry();
    double sum = 0;
    for (int i = 0; i < 720; ++i)
        for (int j = 0; j < 1500; ++j) {
            const double gamma = (j + 0.5) * 0.1;
            sum += crooked.at(i * 0.5 + 0.25, gamma) * std::sin(gamma * pi / 180);
        }
    sum *= 0.5 * pi / 180 * 0.1 * pi / 180;
    EXPECT_NEAR(crooked.flux(), sum, 1e-5 * sum);
}

TEST(Photometry, DirectionsAreSampledInProportionToTheFlux) {
    const Photometry p = crooked_photometry();
    const DirectionSampler sampler(p);
    // Mean direction ∫ ω I dω / Φ, by samples and by brute force.
    Vec3 found, exact;
    double weight = 0, flux = 0, largest = 0;
    constexpr std::uint32_t n = 1 << 16;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [u, v] = low_discrepancy(7, i);
        const auto s = sampler.sample((i + 0.5) / n, u, v);
        found += s.direction * (s.weight / n);
        weight += s.weight / n;
        largest = std::max(largest, s.weight);
    }
    for (int i = 0; i < 360; ++i)
        for (int j = 0; j < 750; ++j) {
            const double gamma = (j + 0.5) * 0.2;
            const double I = p.at(i + 0.5, gamma) * std::sin(gamma * pi / 180);
            exact += direction(i + 0.5, gamma) * I;
            flux += I;
        }
    EXPECT_NEAR(weight, 1, 2e-3);
    EXPECT_LT(largest, 4) << "no cell is sampled far too rarely";
    EXPECT_LT(length(found - exact / flux), 3e-3);
}

TEST(Photometry, MirroredTurnsTheOtherWayRound) {
    const Photometry p = crooked_photometry(), m = mirrored(p);
    for (const double c : {0.0, 30.0, 95.0, 200.0, 359.0})
        EXPECT_NEAR(m.at(c, 42), p.at(-c, 42), 1e-9);
    EXPECT_NEAR(m.flux(), p.flux(), 1e-9 * p.flux());
}

TEST(Photometry, TiltFactorsAreInterpolated) {
    const LampTilt tilt{{0, 30, 90}, {1, 0.9, 0.6}};
    EXPECT_EQ(tilt.factor(-5), 1);
    EXPECT_NEAR(tilt.factor(60), 0.75, 1e-12);
    EXPECT_EQ(tilt.factor(120), 0.6);
    EXPECT_EQ(LampTilt{}.factor(45), 1);
}

TEST(LampFigures, OfALambertianLamp) {
    const LampFigures f = figures_of(cosine_photometry(1000));
    EXPECT_NEAR(f.beam[0], 120, 1e-3) << "cos 60° = 0.5";
    EXPECT_NEAR(f.field[1], 2 * std::acos(0.1) * 180 / pi, 1e-3);
    EXPECT_EQ(f.peak, 1000);
    EXPECT_EQ(f.symmetry, LampSymmetry::rotational);
    EXPECT_NEAR(f.downward, 1, 1e-9);
    EXPECT_FALSE(f.efficacy || f.output_ratio);
}

TEST(LampFigures, BeamAndFieldOfASpotAreWhatWasAskedFor) {
    const LampFigures f = figures_of(spot_photometry(24, 40));
    EXPECT_NEAR(f.beam[0], 24, 0.02);
    EXPECT_NEAR(f.field[1], 40, 0.02);
    EXPECT_NEAR(f.peak, 1, 1e-12);
}

TEST(LampFigures, AnglesOfAnUplightAreThoseOfItsUpperSide) {
    Photometry up = cosine_photometry(1000);
    for (double& gamma : up.gammas) gamma = 90 + gamma;
    std::reverse(up.candela.begin(), up.candela.end());
    const LampFigures f = figures_of(up);
    EXPECT_NEAR(f.beam[0], 120, 1e-3);
    EXPECT_NEAR(f.downward, 0, 1e-9);
    EXPECT_EQ(f.peak_gamma, 180);
}

TEST(LampFigures, SymmetryIsThatOfTheTable) {
    const auto of = [](auto&& I) {
        Photometry p;
        p.gammas = {0, 45, 90};
        for (double c = 0; c <= 360; c += 15) {
            p.planes.push_back(c);
            for (const double gamma : p.gammas) p.candela.push_back(1 + gamma * I(c * pi / 180));
        }
        return figures_of(p).symmetry;
    };
    EXPECT_EQ(of([](double) { return 1.0; }), LampSymmetry::rotational);
    EXPECT_EQ(of([](double c) { return 1.1 + std::cos(2 * c); }), LampSymmetry::both);
    EXPECT_EQ(of([](double c) { return 1.1 + std::cos(c); }), LampSymmetry::about_c0);
    EXPECT_EQ(of([](double c) { return 1.1 + std::sin(c); }), LampSymmetry::about_c90);
    EXPECT_EQ(of([](double c) { return 1.1 + std::sin(c + 0.5); }), LampSymmetry::none);
}

TEST(LuminousOpening, FacetsCloseTheBody) {
    for (const LuminousOpening& opening : testing::all_openings()) {
        Vec3 sum;
        double total = 0;
        for (const OpeningFacet& f : facets(opening)) {
            sum += f.normal * f.area;
            total += f.area;
            Vec3 middle;
            for (std::uint32_t i = 0; i < f.count; ++i) middle += f.corners[i] / f.count;
            EXPECT_GE(dot(middle, f.normal), -1e-12) << "faces outwards";
        }
        // Sides that shine in part leave the body open there.
        if (opening.sides_shine) {
            EXPECT_LT(length(sum), 1e-12 * std::max(1.0, total));
        }
    }
    const auto disc = facets(testing::opening(LuminousOpening::Shape::cylinder, {0.4, 0.4, 0}));
    double area = 0;
    for (const OpeningFacet& f : disc) area += f.area;
    EXPECT_NEAR(area, 2 * pi * 0.04, 1e-12) << "both sides of a disc";
}

TEST(Luminaire, HasARightHandedFrame) {
    const Luminaire l = testing::hanging(crooked_photometry(), {0, 0, 3}, 2);
    // Seen from above, C runs counter-clockwise: C90 is +y where C0 is +x and nadir is −z.
    EXPECT_NEAR(length(l.to_world({0, 1, 0}) - Vec3{0, 1, 0}), 0, 1e-12);
    EXPECT_NEAR(l.intensity(direction(60, 40)), 2 * l.photometry->at(60, 40), 1e-9);
    EXPECT_NEAR(l.flux(), 2 * l.photometry->flux(), 1e-9);
    const Vec3 d = normalized(Vec3{1, 2, -3});
    EXPECT_NEAR(length(l.to_world(l.to_photometric(d)) - d), 0, 1e-12);
}

}  // namespace
}  // namespace exitance
