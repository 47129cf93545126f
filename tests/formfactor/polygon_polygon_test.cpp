// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/polygon_polygon.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "exitance/math/frame.h"
#include "exitance/math/quadrature.h"
#include "exitance/run/random.h"
#include "formfactor/view_factor_cases.h"

namespace exitance {
namespace {

using namespace view_factors;

Vec3 random_direction(std::uint64_t key) {
    const double z = 2 * uniform(key, 0) - 1, phi = 2 * std::numbers::pi * uniform(key, 1);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

std::vector<Vec3> random_polygon(std::uint64_t key, std::size_t n) {
    const Vec3 centre = random_direction(key) * (1.5 * uniform(key, 9));
    const Frame frame(random_direction(key + 1));
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle =
            2 * std::numbers::pi * (double(i) + 0.8 * uniform(key, 20 + i)) / double(n);
        corners.push_back(centre + frame.tangent * std::cos(angle) +
                          frame.bitangent * (0.6 * std::sin(angle)));
    }
    return corners;
}

TEST(PolygonPolygon, ParallelRectangles) {
    for (const double c : {1e-3, 0.1, 1.0, 10.0, 300.0}) {
        const double exact = parallel(1, 2, c);
        EXPECT_NEAR(
            exchange_area(level(0, 1, 0, 2, 0, true), level(0, 1, 0, 2, c, false), 1e-12) / 2,
            exact, 1e-11 + 1e-9 * exact)
            << c;
    }
}

TEST(PolygonPolygon, ParallelRectanglesOffset) {
    const double exact = offset_parallel({0, 1}, {0, 1}, {0.3, 0.7}, {1, 2}, 0.3);
    EXPECT_NEAR(exchange_area(level(0, 1, 0, 1, 0, true), level(0.3, 0.7, 1, 2, 0.3, false), 1e-12),
                exact, 1e-11);
}

TEST(PolygonPolygon, SharedEdge) {
    for (const double h : {1e-2, 0.3, 1.0, 20.0}) {
        const Quad wall{{{0, 0, 0}, {0, 3, 0}, {0, 3, h}, {0, 0, h}}};
        EXPECT_NEAR(exchange_area(level(0, 1, 0, 3, 0, true), wall, 1e-12) / 3,
                    perpendicular(3, 1, h), 1e-10)
            << h;
    }
}

TEST(PolygonPolygon, FacesOfARegularTetrahedron) {
    const std::array<Vec3, 3> a{{{-1, 1, -1}, {1, -1, -1}, {1, 1, 1}}};
    const std::array<Vec3, 3> b{{{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}}};
    EXPECT_NEAR(exchange_area(a, b, 1e-12) / area(a), 1.0 / 3, 1e-11);
}

TEST(PolygonPolygon, WhatIsBehindTheOthersPlaneDoesNotCount) {
    // The wall reaches below the floor it stands on.
    const Quad wall{{{0, 0, -5}, {0, 1, -5}, {0, 1, 1}, {0, 0, 1}}};
    EXPECT_NEAR(exchange_area(level(0, 1, 0, 1, 0, true), wall, 1e-12), perpendicular(1, 1, 1),
                1e-10);
    EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0, true), level(0, 1, 0, 1, 1, true)), 0);
    EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0, true), level(0, 1, 0, 1, -1, true)), 0);
}

TEST(PolygonPolygon, SharedCorner) {
    // Rectangles that meet in one corner are what is missing from two that share an edge:
    // F(1+1', 2+2') = F(1, 2) + F(1', 2') + 2 F(1, 2') for halves side by side.
    const Quad wall{{{0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 1, 1}}};
    const double both = 2 * perpendicular(2, 1, 1), same = perpendicular(1, 1, 1);
    EXPECT_NEAR(exchange_area(level(0, 1, 0, 1, 0, true), wall, 1e-12), 0.5 * (both - 2 * same),
                1e-10);
}

RC_GTEST_PROP(PolygonPolygon, IsSymmetric, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto a = random_polygon(key, 3 + key % 4), b = random_polygon(key + 77, 3 + key % 3);
    const double there = exchange_area(a, b, 1e-9), back = exchange_area(b, a, 1e-9);
    RC_ASSERT(std::abs(there - back) < 1e-8);
    RC_ASSERT(there >= 0 && there <= std::min(area(a), area(b)));
}

RC_GTEST_PROP(PolygonPolygon, SurvivesMovingTurningAndScaling, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    auto a = random_polygon(key, 4), b = random_polygon(key + 77, 3);
    const double before = exchange_area(a, b, 1e-9);
    const Frame turn(random_direction(key + 4));
    const double scale = std::exp(6 * uniform(key, 5) - 3);
    const Vec3 shift = random_direction(key + 6) * 5;
    for (auto* polygon : {&a, &b})
        for (Vec3& p : *polygon) p = shift + turn.to_world(p) * scale;
    RC_ASSERT(std::abs(exchange_area(a, b, 1e-9) - before * scale * scale) < 1e-7 * scale * scale);
}

RC_GTEST_PROP(PolygonPolygon, PartsAddUp, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto a = random_polygon(key, 4), b = random_polygon(key + 77, 5);
    const Vec3 ab = 0.5 * (a[0] + a[1]), cd = 0.5 * (a[2] + a[3]);
    const double sum = exchange_area(std::array{a[0], ab, cd, a[3]}, b, 1e-9) +
                       exchange_area(std::array{ab, a[1], a[2], cd}, b, 1e-9);
    RC_ASSERT(std::abs(sum - exchange_area(a, b, 1e-9)) < 1e-7);
}

TEST(GaussLegendre, IsExactForPolynomials) {
    const auto& rule = gauss_legendre<6>();
    for (int power = 0; power <= 11; ++power) {
        double sum = 0;
        for (std::size_t k = 0; k < 6; ++k) sum += rule.weight[k] * std::pow(rule.at[k], power);
        EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-14) << power;
    }
}

}  // namespace
}  // namespace exitance
