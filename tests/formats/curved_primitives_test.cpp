// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/curved_primitives.h"

#include <gtest/gtest.h>

#include <numbers>

#include "exitance/math/polygon.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

// Side of a frustum made of n trapezoids: chords 2 r sin(π/n), between apothems r cos(π/n).
double trapezoids(double r0, double r1, double height, std::uint32_t n) {
    const double chords = r0 * std::sin(pi / n) + r1 * std::sin(pi / n);
    return n * chords * std::hypot(height, (r0 - r1) * std::cos(pi / n));
}

std::vector<Vec3> corners(const Facets& facets, std::size_t i) {
    std::vector<Vec3> out;
    for (const std::uint32_t c : facets.polygons[i])
        if (c != Polygon::none) out.push_back(facets.points[c]);
    return out;
}

// Signed volume inside a closed set of facets.
double volume(const Facets& facets) {
    double sum = 0;
    for (std::size_t i = 0; i < facets.polygons.size(); ++i) {
        const auto c = corners(facets, i);
        sum += dot(vector_area(c), c[0]) / 3;
    }
    return sum;
}

// Fronts and shading normals agree.
void expect_facing(const Facets& facets) {
    for (std::size_t i = 0; i < facets.polygons.size(); ++i) {
        const Vec3 normal = unit_normal(corners(facets, i));
        for (const std::uint32_t c : facets.polygons[i])
            if (c != Polygon::none && facets.normals[c] != Vec3{}) {
                EXPECT_GT(dot(normal, facets.normals[c]), 0.7);
                EXPECT_NEAR(length(facets.normals[c]), 1, 1e-12);
            }
        EXPECT_LT(planarity_error(corners(facets, i)), 1e-12);
    }
}

TEST(CurvedPrimitives, FacetsFollowTheTolerance) {
    // 1 − cos(π/16) = 0.0192 is the first multiple of 4 below 0.02.
    EXPECT_EQ(facets_per_turn(0.02), 16U);
    EXPECT_EQ(facets_per_turn(0.5), 8U);
    EXPECT_EQ(facets_per_turn(1 - std::cos(pi / 64)), 64U);
    for (const double tolerance : {0.1, 0.01, 0.001}) {
        const std::uint32_t n = facets_per_turn(tolerance);
        EXPECT_LE(1 - std::cos(pi / n), tolerance * (1 + 1e-9));
        EXPECT_GT(1 - std::cos(pi / (n - 4)), tolerance);
    }
}

TEST(CurvedPrimitives, Sphere) {
    const Facets facets = sphere_facets({1, 2, 3}, 0.5, 16);
    EXPECT_EQ(facets.polygons.size(), 128U);
    EXPECT_EQ(facets.polygons.size(), sphere_facet_count(16));
    EXPECT_EQ(facets.points.size(), 2U + 7 * 16);
    double expected = 0;
    for (int r = 0; r < 8; ++r) {
        const double a = pi * r / 8, b = pi * (r + 1) / 8;
        expected +=
            trapezoids(0.5 * std::sin(a), 0.5 * std::sin(b), 0.5 * (std::cos(a) - std::cos(b)), 16);
    }
    EXPECT_NEAR(facets.area(), expected, 1e-12);
    EXPECT_NEAR(facets.true_area, pi, 1e-12);
    for (const Vec3& p : facets.points) EXPECT_NEAR(length(p - Vec3{1, 2, 3}), 0.5, 1e-12);
    expect_facing(facets);
    // Finer facets come to the sphere's area with the square of their size.
    const double at_64 = sphere_facets({}, 1, 64).area() / (4 * pi);
    EXPECT_NEAR(at_64, 1, 0.0021);
    EXPECT_NEAR((1 - at_64) / (1 - sphere_facets({}, 1, 128).area() / (4 * pi)), 4, 0.02);
    EXPECT_GT(volume(sphere_facets({}, 1, 16)), 0);
}

TEST(CurvedPrimitives, ConesAndCylinders) {
    struct Case {
        double r0, r1;
    };
    for (const Case& c : {Case{2, 2}, Case{2, 1}, Case{0, 1}, Case{1.5, 0}}) {
        const Facets facets = frustum_facets({1, 0, 0}, c.r0, {1, 3, 4}, c.r1, 12);
        EXPECT_EQ(facets.polygons.size(), 12U);
        EXPECT_NEAR(facets.area(), trapezoids(c.r0, c.r1, 5, 12), 1e-12);
        EXPECT_NEAR(facets.true_area, pi * (c.r0 + c.r1) * std::hypot(5, c.r0 - c.r1), 1e-12);
        expect_facing(facets);
    }
    Facets inward = frustum_facets({}, 1, {0, 0, 1}, 1, 12);
    inward.turn_round();
    expect_facing(inward);
    EXPECT_LT(dot(inward.normals[0], inward.points[0]), 0);
}

TEST(CurvedPrimitives, RingsAndDiscs) {
    const Facets ring = ring_facets({0, 0, 1}, {0, 0, -1}, 1, 2, 16);
    EXPECT_EQ(ring.polygons.size(), 16U);
    EXPECT_NEAR(ring.area(), 8 * std::sin(pi / 8) * 3, 1e-12);  // n/2 sin(2π/n) (R² − r²)
    const Facets disc = ring_facets({}, normalized(Vec3{1, 2, 3}), 0, 2, 16);
    EXPECT_NEAR(disc.area(), 8 * std::sin(pi / 8) * 4, 1e-12);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(unit_normal(corners(ring, i)).z, -1, 1e-12);
        EXPECT_NEAR(dot(unit_normal(corners(disc, i)), normalized(Vec3{1, 2, 3})), 1, 1e-12);
    }
}

TEST(CurvedPrimitives, Torus) {
    const std::uint32_t n = 24;
    const Facets facets = torus_facets({1, 1, 1}, {0, 1, 0}, 2, 3, n);
    EXPECT_EQ(facets.polygons.size(), n * n);
    double expected = 0;
    for (std::uint32_t j = 0; j < n; ++j) {
        const double a = 2 * pi * j / n, b = 2 * pi * (j + 1) / n;
        expected += trapezoids(2.5 + 0.5 * std::cos(a), 2.5 + 0.5 * std::cos(b),
                               0.5 * std::abs(std::sin(a) - std::sin(b)), n);
    }
    EXPECT_NEAR(facets.area(), expected, 1e-10);
    EXPECT_NEAR(facets.true_area, 4 * pi * pi * 2.5 * 0.5, 1e-12);
    expect_facing(facets);
    EXPECT_GT(volume(torus_facets({}, {0, 1, 0}, 2, 3, n)), 0);
}

TEST(CurvedPrimitives, DiscsCloseACylinderFromBothEnds) {
    const Vec3 from{0.1, 0.2, 0.3}, to{1.3, -0.4, 2.1};
    const Vec3 axis = normalized(to - from);
    Facets all = frustum_facets(from, 0.7, to, 0.7, 16);
    for (const bool top : {false, true}) {
        const Facets disc = ring_facets(top ? to : from, top ? axis : -axis, 0, 0.7, 16);
        // Every rim point is one of the cylinder's.
        for (std::size_t i = 1; i < disc.points.size(); ++i) {
            double nearest = 1;
            for (const Vec3& p : all.points)
                nearest = std::min(nearest, length(p - disc.points[i]));
            EXPECT_LT(nearest, 1e-14);
        }
    }
}

}  // namespace
}  // namespace exitance
