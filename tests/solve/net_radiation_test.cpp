// SPDX-License-Identifier: Apache-2.0
// Net radiation against the textbook's closed forms (Incropera & DeWitt, ch. 13; Modest, ch. 5).
#include "exitance/solve/net_radiation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "exitance/run/error.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

FormFactorMatrix matrix(const std::vector<double>& areas,
                        const std::vector<std::vector<double>>& rows) {
    FormFactorMatrix F(areas);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<FormFactorMatrix::Entry> entries;
        for (std::size_t j = 0; j < rows[i].size(); ++j)
            if (rows[i][j] != 0)
                entries.push_back({static_cast<std::uint32_t>(j), static_cast<float>(rows[i][j])});
        F.set_row(i, std::move(entries));
    }
    return F;
}

ThermalSurface at(double temperature, double emissivity) {
    return {emissivity, temperature, {}};
}

ThermalSurface giving(double heat_flux, double emissivity) {
    return {emissivity, {}, heat_flux};
}

double black(double temperature) {
    return stefan_boltzmann * std::pow(temperature, 4);
}

const std::vector<std::string> names{"first", "second", "third", "fourth"};

NetRadiation solve(const FormFactorMatrix& F, const std::vector<ThermalSurface>& surfaces,
                   double surroundings = 0) {
    const NetRadiation result = net_radiation(F, surfaces, surroundings, names);
    // Factors are floats, 6e-8 each, of all that is radiated.
    double radiated = 0;
    for (std::size_t i = 0; i < F.rows(); ++i)
        radiated += F.areas()[i] * result.surfaces[i].radiosity;
    EXPECT_LE(std::abs(result.imbalance), 1e-6 * radiated);
    return result;
}

TEST(NetRadiation, BetweenParallelPlates) {
    const NetRadiation r = solve(matrix({2, 2}, {{0, 1}, {1, 0}}), {at(500, 0.8), at(300, 0.5)});
    const double q = (black(500) - black(300)) / (1 / 0.8 + 1 / 0.5 - 1);
    EXPECT_NEAR(r.surfaces[0].heat_flux, q, 1e-5 * q);
    EXPECT_NEAR(r.surfaces[0].heat, 2 * q, 2e-5 * q);
    EXPECT_NEAR(r.surfaces[1].heat, -2 * q, 2e-5 * q);
    // What leaves is emitted or reflected.
    EXPECT_NEAR(r.surfaces[0].radiosity, 0.8 * black(500) + 0.2 * r.surfaces[0].irradiation,
                1e-5 * black(500));
}

TEST(NetRadiation, BetweenBlackPlates) {
    const NetRadiation r = solve(matrix({1, 1}, {{0, 1}, {1, 0}}), {at(400, 1), at(300, 1)});
    EXPECT_NEAR(r.surfaces[0].heat_flux, black(400) - black(300), 1e-3);
}

TEST(NetRadiation, OfABodyInsideAnother) {
    // Concentric spheres, cylinders or a convex body in a box.
    const NetRadiation r =
        solve(matrix({1, 4}, {{0, 1}, {0.25, 0.75}}), {at(600, 0.3), at(350, 0.6)});
    const double Q = (black(600) - black(350)) / (1 / 0.3 + 0.25 * (1 / 0.6 - 1));
    EXPECT_NEAR(r.surfaces[0].heat, Q, 1e-5 * Q);
    EXPECT_NEAR(r.surfaces[1].heat, -Q, 1e-5 * Q);
}

TEST(NetRadiation, OfASmallBodyInALargeEnclosure) {
    const double share = 1e-6;  // of the areas: the enclosure is black for the body
    const NetRadiation r =
        solve(matrix({share, 1}, {{0, 1}, {share, 1 - share}}), {at(500, 0.7), at(290, 0.2)});
    EXPECT_NEAR(r.surfaces[0].heat_flux, 0.7 * (black(500) - black(290)), 0.01);
}

TEST(NetRadiation, WithAReradiatingWall) {
    // A long triangular duct, F = 1/2: two grey plates and an insulated third.
    const double e1 = 0.8, e2 = 0.4, half = 0.5;
    const NetRadiation r =
        solve(matrix({1, 1, 1}, {{0, half, half}, {half, 0, half}, {half, half, 0}}),
              {at(1000, e1), at(400, e2), giving(0, 0.9)});
    const double between = half + 1 / (1 / half + 1 / half);
    const double Q = (black(1000) - black(400)) / ((1 - e1) / e1 + 1 / between + (1 - e2) / e2);
    EXPECT_NEAR(r.surfaces[0].heat, Q, 1e-5 * Q);
    EXPECT_NEAR(r.surfaces[1].heat, -Q, 1e-5 * Q);
    EXPECT_NEAR(r.surfaces[2].heat, 0, 1e-5 * Q);
    // It takes the temperature of what it sees, whatever its emissivity.
    const double mean = 0.5 * (r.surfaces[0].radiosity + r.surfaces[1].radiosity);
    EXPECT_NEAR(black(r.surfaces[2].temperature), mean, 1e-5 * mean);
}

TEST(NetRadiation, OfAnOpenEnclosureWithItsSurroundings) {
    // Alone in the open.
    NetRadiation r = solve(matrix({3}, {{0}}), {at(350, 0.6)}, 280);
    const double q = 0.6 * (black(350) - black(280));
    EXPECT_NEAR(r.surfaces[0].heat_flux, q, 1e-5 * q);
    EXPECT_NEAR(r.lost, 3 * q, 3e-5 * q);
    // A groove of two plates at one temperature: it looks blacker than they are.
    const double F = 0.7, e = 0.4;
    r = solve(matrix({1, 1}, {{0, F}, {F, 0}}), {at(500, e), at(500, e)});
    const double J = e * black(500) / (1 - (1 - e) * F);
    EXPECT_NEAR(r.lost, 2 * (1 - F) * J, 1e-4 * J);
}

TEST(NetRadiation, ASurfaceThatNeitherEmitsNorGivesHeatHasNoTemperature) {
    const NetRadiation r = solve(matrix({1, 1}, {{0, 1}, {1, 0}}), {at(400, 1), giving(0, 0)});
    EXPECT_TRUE(std::isnan(r.surfaces[1].temperature));
    EXPECT_NEAR(r.surfaces[0].heat, 0, 1e-3);
}

TEST(NetRadiation, WhatCannotBeIsRefused) {
    const FormFactorMatrix F = matrix({1, 1}, {{0, 1}, {1, 0}});
    const auto refusal = [&](const std::vector<ThermalSurface>& surfaces) -> std::string {
        try {
            net_radiation(F, surfaces, 0, names);
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::bad_input);
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal({at(300, 1), {}}),
              "'second' has neither a temperature nor a heat flux, expected one of them");
    EXPECT_EQ(refusal({at(300, 1), {1, 300, 5}}),
              "'second' has both a temperature and a heat flux, expected one of them");
    EXPECT_EQ(refusal({at(300, 1), giving(5, 0)}),
              "'second' has a heat flux and emissivity 0: it cannot send heat out");
    EXPECT_EQ(refusal({giving(5, 1), giving(-5, 1)}),
              "no surface has a temperature and nothing is lost: the level of the others is not "
              "determined");
    EXPECT_EQ(refusal({at(300, 1), giving(-5000, 1)}),
              "'second' cannot take in so much heat: even at 0 K less arrives");
}

// Temperatures give heat; that heat gives the temperatures back.
RC_GTEST_PROP(NetRadiation, HeatAndTemperatureAreInverse, (std::uint32_t seed)) {
    constexpr std::size_t n = 4;
    std::uint64_t counter = 0;
    const auto draw = [&] { return uniform(hash_bits(seed), counter++); };
    ExchangeAreas S(n);
    std::vector<double> areas(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<float> row;
        for (std::size_t j = 0; j <= i; ++j) {
            row.push_back(static_cast<float>(0.1 + draw()));
            areas[i] += double(row.back());
            if (j != i) areas[j] += double(row.back());
        }
        S.set_row(i, row);
    }
    const FormFactorMatrix F(areas, S);
    std::vector<ThermalSurface> surfaces;
    for (std::size_t i = 0; i < n; ++i)
        surfaces.push_back(at(250 + 500 * draw(), 0.1 + 0.9 * draw()));
    const NetRadiation first = net_radiation(F, surfaces, 0, names);
    std::vector<ThermalSurface> swapped = surfaces;
    for (std::size_t i = 1; i < n; ++i)
        swapped[i] = giving(first.surfaces[i].heat_flux, surfaces[i].emissivity);
    const NetRadiation second = net_radiation(F, swapped, 0, names);
    for (std::size_t i = 0; i < n; ++i)
        RC_ASSERT(std::abs(second.surfaces[i].temperature - *surfaces[i].temperature) < 0.01);
}

}  // namespace
}  // namespace exitance
