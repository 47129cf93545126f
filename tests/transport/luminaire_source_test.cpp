// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/luminaire_source.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/point_polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "scene/lamps.h"

namespace exitance {
namespace {

using testing::all_openings;
using testing::cosine_photometry;
using testing::crooked_photometry;
using testing::hanging;

TEST(LuminaireSource, AThousandCandelaTimesCosineThreeMetresUp) {
    // E = I cosθ / r² = 1000 h² / r⁴: 1000 / 9, and with r² = 9 + 4.5: 9000 / 13.5².
    const LuminaireSource lamp(hanging(cosine_photometry(1000), {0, 0, 3}));
    EXPECT_NEAR(lamp.irradiance({0, 0, 0}, {0, 0, 1}), 111.1111111, 1e-7);
    EXPECT_NEAR(lamp.irradiance({1.5, 1.5, 0}, {0, 0, 1}), 9000 / (13.5 * 13.5), 5e-5);
    EXPECT_EQ(lamp.irradiance({0, 0, 0}, {0, 0, -1}), 0);
    EXPECT_EQ(lamp.irradiance({0, 0, 4}, {0, 0, -1}), 0) << "nothing goes up";
}

TEST(LuminaireSource, FarAwayEveryOpeningGivesTheIntensity) {
    for (const LuminousOpening& opening : all_openings()) {
        const LuminaireSource lamp(hanging(crooked_photometry(opening), {1, 2, 3}));
        for (const Vec3& way : {Vec3{0.3, 0.2, -1}, Vec3{-1, 0.5, -0.2}, Vec3{0.1, -1, 0.9}}) {
            const Vec3 d = normalized(way);
            const double r = 1e4;
            const double I = lamp.luminaire().intensity(d);
            ASSERT_GT(I, 1);
            // What is left is of the order of (size / distance).
            EXPECT_NEAR(lamp.irradiance(Vec3{1, 2, 3} + d * r, -d) * r * r, I, 1e-3 * I)
                << "shape " << int(opening.shape);
        }
    }
}

// Irradiance over the walls of a box around the lamp, by Gauss points in a fine grid.
double received(const LuminaireSource& lamp, const Vec3& low, const Vec3& high) {
    constexpr std::size_t cells = 24;
    constexpr double gauss = 0.288675134594812882;
    double total = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
            const double width = high[a] - low[a], height = high[b] - low[b];
            Vec3 normal;
            normal[axis] = upper ? -1 : 1;
            total += parallel_sum<double>(
                cells,
                [&](std::size_t begin, std::size_t end) {
                    double sum = 0;
                    for (std::size_t i = begin; i < end; ++i)
                        for (std::size_t j = 0; j < cells; ++j)
                            for (const double du : {-gauss, gauss})
                                for (const double dv : {-gauss, gauss}) {
                                    Vec3 p;
                                    p[axis] = upper ? high[axis] : low[axis];
                                    p[a] = low[a] + width * (double(i) + 0.5 + du) / cells;
                                    p[b] = low[b] + height * (double(j) + 0.5 + dv) / cells;
                                    sum += lamp.irradiance(p, normal);
                                }
                    return sum * width * height / (cells * cells * 4);
                },
                1);
        }
    return total;
}

TEST(LuminaireSource, WhatAClosedBlackBoxReceivesIsTheFlux) {
    // 0.1 %: of kinks of the table between Gauss points, and of the quadrature of near openings.
    for (const LuminousOpening& opening : all_openings()) {
        const LuminaireSource lamp(hanging(crooked_photometry(opening), {1.1, 1.3, 1.4}));
        const double flux = lamp.luminaire().flux();
        EXPECT_NEAR(received(lamp, {0, 0, 0}, {2.5, 3, 2.2}), flux, 1e-3 * flux)
            << "shape " << int(opening.shape) << ", size " << opening.size.x << " "
            << opening.size.y << " " << opening.size.z;
    }
}

TEST(LuminaireSource, AnEvenPanelIsAPolygonWithItsFormFactor) {
    // I = I₀ cos γ from a rectangle of area A is exitance π I₀ / A: E = M F, at any distance.
    const auto shape = testing::opening(LuminousOpening::Shape::box, {1.2, 0.5, 0});
    const LuminaireSource lamp(hanging(cosine_photometry(100, shape), {0, 0, 2}));
    const std::array<Vec3, 4> corners{
        {{-0.6, -0.25, 2}, {-0.6, 0.25, 2}, {0.6, 0.25, 2}, {0.6, -0.25, 2}}};
    const double exitance = 100 * std::numbers::pi / 0.6;
    for (const Vec3& p :
         {Vec3{0, 0, 0}, Vec3{0.4, 0.1, 1.5}, Vec3{0.2, -0.1, 1.9}, Vec3{2, 1, 1}}) {
        const double exact = exitance * point_polygon_factor(p, {0, 0, 1}, corners);
        EXPECT_NEAR(lamp.irradiance(p, {0, 0, 1}), exact, 1e-3 * exact) << p.z;
    }
}

TEST(LuminaireSource, ANarrowBeamOfAWidePanelIsNotMissed) {
    // 1° wide in steps of 0.1°: half a metre below the panel only the places above it shine there.
    // A = 1 m²: E = ∫ I(θ) cosθ / r² dA = 2π ∫ I tanθ dθ in a parallel beam.
    Photometry narrow;
    narrow.planes = {0};
    narrow.opening = testing::opening(LuminousOpening::Shape::box, {1, 1, 0});
    double exact = 0;
    constexpr double degree = std::numbers::pi / 180;
    for (int i = 0; i <= 40; ++i) {
        narrow.gammas.push_back(0.1 * i);
        narrow.candela.push_back(1000 * std::exp(-std::numbers::ln2 * std::pow(0.2 * i, 2)));
    }
    for (int i = 0; i < 4000; ++i) {
        const double theta = (i + 0.5) * 1e-3 * degree;
        exact +=
            2 * std::numbers::pi * narrow.at(0, theta / degree) * std::tan(theta) * 1e-3 * degree;
    }
    const LuminaireSource lamp(hanging(narrow, {0, 0, 2}));
    for (const Vec3& p : {Vec3{0.1, 0.2, 1.5}, Vec3{0, 0, 1.9}, Vec3{-0.31, 0.17, 0}})
        EXPECT_NEAR(lamp.irradiance(p, {0, 0, 1}), exact, 0.02 * exact) << p.z;
    EXPECT_EQ(lamp.irradiance({0.6, 0, 1.5}, {0, 0, 1}), 0);
}

TEST(LuminaireSource, SamplesAverageToTheIrradiance) {
    for (const LuminousOpening& opening : all_openings()) {
        const LuminaireSource lamp(hanging(crooked_photometry(opening), {0, 0, 2}));
        if (lamp.is_point()) continue;
        const Vec3 p{0.5, 0.2, 0.9}, n = normalized(Vec3{-0.2, 0.1, 1});
        LuminaireSource::View view;
        lamp.look(p, view);
        double sum = 0;
        constexpr std::uint32_t count = 1 << 14;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto [u, v] = low_discrepancy(3, i);
            sum += lamp.sample(view, p, n, u, v).weight / count;
        }
        const double exact = lamp.irradiance(p, n);
        EXPECT_NEAR(sum, exact, 2e-3 * exact) << "shape " << int(opening.shape);
    }
}

}  // namespace
}  // namespace exitance
