// SPDX-License-Identifier: Apache-2.0
#include "exitance/math/spherical_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/run/random.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

TEST(SphericalTriangle, SolidAnglesThatAreKnown) {
    // An octant; a half octant; a quarter of a cube's face seen from its middle.
    EXPECT_NEAR(SphericalTriangle({1, 0, 0}, {0, 2, 0}, {0, 0, 3}).solid_angle(), pi / 2, 1e-12);
    EXPECT_NEAR(SphericalTriangle({1, 0, 0}, {0, 0, 1}, {1, 1, 0}).solid_angle(), pi / 4, 1e-12);
    EXPECT_NEAR(SphericalTriangle({1, 1, 1}, {-1, 1, 1}, {0, 0, 1}).solid_angle(), pi / 6, 1e-12);
    // More than half of all directions is not a triangle's; nearly half is: a plane close by.
    EXPECT_NEAR(
        SphericalTriangle({1e3, 0, 1e-3}, {-1e3, 2e3, 1e-3}, {-1e3, -2e3, 1e-3}).solid_angle(),
        2 * pi, 1e-5);
    // Small ones do not lose their digits: area over distance squared.
    EXPECT_NEAR(SphericalTriangle({0, 0, 1}, {1e-5, 0, 1}, {0, 1e-5, 1}).solid_angle() / 5e-11, 1,
                1e-4);
}

// A sum over evenly spread directions is an integral: of d_z over a triangle it is π times the form
// factor, which Lambert's formula knows; and all directions lie in the triangle.
TEST(SphericalTriangle, DirectionsAreSpreadEvenly) {
    const Vec3 triangles[][3] = {{{1, 0, 0.5}, {0, 1, 0.2}, {-1, -1, 1}},
                                 {{2, 0.1, 0.01}, {-1, 3, 0.01}, {-1, -2, 0.01}},
                                 {{0.1, 0, 2}, {0.3, 0.01, 2}, {0.1, 0.2, 2.5}}};
    for (const auto& [a, b, c] : triangles) {
        const SphericalTriangle triangle(a, b, c);
        Vec3 sum;
        constexpr std::uint32_t n = 4096;
        const double inside = dot(a, cross(b, c)) > 0 ? 1 : -1;
        for (std::uint32_t k = 0; k < n; ++k) {
            const auto u = low_discrepancy_4(7, k);
            const Vec3 d = triangle.direction({u[0], u[1]});
            EXPECT_NEAR(length(d), 1, 1e-9);
            for (const Vec3& normal : {cross(a, b), cross(b, c), cross(c, a)})
                EXPECT_GT(inside * dot(d, normalized(normal)), -1e-7);
            sum += d * (triangle.solid_angle() / n);
        }
        // ∫ d dω = ½ Σ β_i Γ_i, for all three components at once (Lambert).
        Vec3 exact;
        const Vec3 corners[] = {normalized(a), normalized(b), normalized(c)};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &p = corners[k], &q = corners[(k + 1) % 3], across = cross(p, q);
            exact += normalized(across) * (0.5 * std::atan2(length(across), dot(p, q)));
        }
        EXPECT_LT(length(sum - exact * inside), 2e-3 * triangle.solid_angle());
    }
}

}  // namespace
}  // namespace exitance
