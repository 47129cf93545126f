// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <numbers>

#include "exitance/math/box.h"
#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"
#include "exitance/math/transform.h"
#include "exitance/math/warp.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

// A map preserves measure if every cell of the unit square gets its share of the domain: here the
// moments over a fine midpoint rule are those of the domain, to the rule's own accuracy (h²).
template <class Value>
double midpoint_mean(const Value& value) {
    constexpr int n = 512;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) sum += value(UnitSquare{(i + 0.5) / n, (j + 0.5) / n});
    return sum / (n * n);
}

TEST(Warp, CosineHemisphereHasTheMomentsOfItsDensity) {
    // ∫ cosθ^k cosθ/π dω = 2 / (k + 2)
    for (const int k : {1, 2, 3}) {
        const double mean =
            midpoint_mean([&](UnitSquare u) { return std::pow(cosine_hemisphere(u).z, k); });
        EXPECT_NEAR(mean, 2.0 / (k + 2), 2e-5) << k;
    }
    EXPECT_NEAR(midpoint_mean([](UnitSquare u) { return cosine_hemisphere(u).x; }), 0, 1e-12);
    EXPECT_NEAR(midpoint_mean([](UnitSquare u) { return cosine_hemisphere(u).y; }), 0, 1e-12);
    // ∫ sin²θ cos²φ cosθ/π dω = 1/4
    EXPECT_NEAR(midpoint_mean([](UnitSquare u) {
                    const Vec3 d = cosine_hemisphere(u);
                    return d.x * d.x;
                }),
                0.25, 1e-6);
}

TEST(Warp, CosineHemisphereCoversEveryPartEqually) {
    // u[0] is the projected area inside the ring, u[1] the share of the turn.
    for (const double a : {0.0, 0.25, 0.5, 0.999})
        for (const double b : {0.0, 0.3, 0.8}) {
            const Vec3 d = cosine_hemisphere({a, b});
            EXPECT_NEAR(length(d), 1, 1e-15);
            EXPECT_NEAR(d.x * d.x + d.y * d.y, a, 1e-15);
            EXPECT_NEAR(d.x * std::sin(2 * pi * b), d.y * std::cos(2 * pi * b), 1e-15);
            EXPECT_GE(d.z, 0);
        }
}

TEST(Warp, UniformTriangleIsAreaPreserving) {
    // Over a triangle ∫ w_i = 1/3, ∫ w_i² = 1/6, ∫ w_i w_j = 1/12 of the area. The square root
    // costs the midpoint rule an order at u = 0.
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(midpoint_mean([&](UnitSquare u) { return uniform_triangle(u)[i]; }), 1.0 / 3,
                    2e-5);
        EXPECT_NEAR(midpoint_mean([&](UnitSquare u) {
                        const auto w = uniform_triangle(u);
                        return w[i] * w[i];
                    }),
                    1.0 / 6, 2e-5);
        EXPECT_NEAR(midpoint_mean([&](UnitSquare u) {
                        const auto w = uniform_triangle(u);
                        return w[i] * w[(i + 1) % 3];
                    }),
                    1.0 / 12, 2e-5);
    }
}

RC_GTEST_PROP(Warp, UniformTriangleStaysInside, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto w = uniform_triangle({uniform(key, 0), uniform(key, 1)});
    RC_ASSERT(w[0] >= 0 && w[1] >= 0 && w[2] >= 0);
    RC_ASSERT(std::abs(w[0] + w[1] + w[2] - 1) < 1e-15);
}

Vec3 random_direction(std::uint64_t key) {
    const double z = 2 * uniform(key, 0) - 1, phi = 2 * pi * uniform(key, 1);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

void expect_right_handed_frame(const Vec3& n) {
    const Frame f(n);
    EXPECT_EQ(f.normal, n);
    EXPECT_NEAR(length(f.tangent), 1, 1e-14);
    EXPECT_NEAR(length(f.bitangent), 1, 1e-14);
    EXPECT_NEAR(dot(f.tangent, n), 0, 1e-14);
    EXPECT_NEAR(dot(f.bitangent, n), 0, 1e-14);
    EXPECT_NEAR(length(cross(f.tangent, f.bitangent) - n), 0, 1e-14);
    EXPECT_NEAR(
        length(f.to_world({0.2, -0.3, 0.5}) - (f.tangent * 0.2 - f.bitangent * 0.3 + n * 0.5)), 0,
        1e-15);
}

TEST(Frame, IsOrthonormalAndRightHandedEverywhere) {
    for (std::uint64_t i = 0; i < 1000; ++i) expect_right_handed_frame(random_direction(i));
}

TEST(Frame, HasNoSingularDirection) {
    for (const double tiny : {0.0, -0.0, 1e-300, 1e-17, 1e-9, 1e-5})
        for (const double z : {1.0, -1.0}) {
            expect_right_handed_frame(normalized(Vec3{tiny, 0, z}));
            expect_right_handed_frame(normalized(Vec3{tiny, -tiny, z}));
            expect_right_handed_frame(normalized(Vec3{z, tiny, tiny}));
            expect_right_handed_frame(normalized(Vec3{z, tiny, -tiny}));
        }
}

Transform random_transform(std::uint64_t key) {
    const auto vector = [&](std::uint64_t k) {
        return Vec3{uniform(key, 3 * k), uniform(key, 3 * k + 1), uniform(key, 3 * k + 2)} * 4 -
               Vec3{2, 2, 2};
    };
    return {vector(0), vector(1), vector(2), vector(3)};
}

RC_GTEST_PROP(Transform, NormalIsThatOfTheImageOfThePlane, ()) {
    // Reflections included: what was the front stays the side that the image of a point in front
    // is on.
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const Transform t = random_transform(key);
    RC_PRE(std::abs(t.determinant()) > 1e-3);
    const Vec3 n = random_direction(key + 1);
    const Frame plane(n);
    const Vec3 image = t.normal(n);
    const double scale = length(image);
    RC_ASSERT(scale > 0);
    RC_ASSERT(std::abs(dot(image, t.vector(plane.tangent))) < 1e-12 * scale * 10);
    RC_ASSERT(std::abs(dot(image, t.vector(plane.bitangent))) < 1e-12 * scale * 10);
    RC_ASSERT(dot(image, t.vector(n)) > 0);
}

TEST(Transform, MirrorTurnsTheWindingButNotTheNormal) {
    const Transform mirror{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 0, 0}};
    EXPECT_LT(mirror.determinant(), 0);
    EXPECT_EQ(mirror.normal({1, 0, 0}), (Vec3{-1, 0, 0}));
    EXPECT_EQ(mirror.normal({0, 0, 1}), (Vec3{0, 0, 1}));
    const std::array<Vec3, 3> triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    std::array<Vec3, 3> image;
    for (std::size_t i = 0; i < 3; ++i) image[i] = mirror.point(triangle[i]);
    EXPECT_EQ(unit_normal(image), (Vec3{0, 0, -1})) << "corners must be reversed by the caller";
}

RC_GTEST_PROP(Transform, AfterIsComposition, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const Transform a = random_transform(key), b = random_transform(key + 1);
    const Vec3 p = random_direction(key + 2);
    RC_ASSERT(length(a.after(b).point(p) - a.point(b.point(p))) < 1e-13);
    RC_ASSERT(length(a.after(b).vector(p) - a.vector(b.vector(p))) < 1e-13);
    RC_ASSERT(std::abs(a.after(b).determinant() - a.determinant() * b.determinant()) < 1e-10);
}

TEST(Polygon, AreaNormalCentroid) {
    const std::array<Vec3, 4> rectangle{{{1, 1, 2}, {4, 1, 2}, {4, 3, 2}, {1, 3, 2}}};
    EXPECT_DOUBLE_EQ(area(rectangle), 6);
    EXPECT_EQ(unit_normal(rectangle), (Vec3{0, 0, 1}));
    EXPECT_EQ(centroid(rectangle), (Vec3{2.5, 2, 2}));
    EXPECT_EQ(planarity_error(rectangle), 0);
    const std::array<Vec3, 3> triangle{{{0, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
    EXPECT_EQ(vector_area(triangle), (Vec3{3, 0, 0}));
    const std::array<Vec3, 3> line{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
    EXPECT_EQ(area(line), 0);
    EXPECT_EQ(unit_normal(line), (Vec3{}));
}

RC_GTEST_PROP(Polygon, VectorAreaDoesNotDependOnTheFirstCorner, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    std::array<Vec3, 4> quad;
    for (std::uint64_t i = 0; i < 4; ++i) quad[i] = random_direction(key + i);
    const Vec3 before = vector_area(quad);
    std::rotate(quad.begin(), quad.begin() + 1, quad.end());
    RC_ASSERT(length(vector_area(quad) - before) < 1e-14);
    std::reverse(quad.begin(), quad.end());
    RC_ASSERT(length(vector_area(quad) + before) < 1e-14);
}

TEST(Polygon, PlanarityErrorIsTheBendOfOneCorner) {
    // A unit square with one corner lifted by h: the plane through the mean leaves every corner
    // h/4 off (to first order).
    const double h = 1e-4;
    const std::array<Vec3, 4> bent{{{0, 0, 0}, {1, 0, 0}, {1, 1, h}, {0, 1, 0}}};
    EXPECT_NEAR(planarity_error(bent), h / 4, 1e-9);
}

TEST(Box, IsEmptyUntilAPointIsAdded) {
    Box box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(box.diagonal(), 0);
    box.add({1, 2, 3});
    EXPECT_FALSE(box.empty());
    box.add({-1, 2, 7});
    EXPECT_EQ(box.size(), (Vec3{2, 0, 4}));
    EXPECT_EQ(box.centre(), (Vec3{0, 2, 5}));
}

}  // namespace
}  // namespace exitance
