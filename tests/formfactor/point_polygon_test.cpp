// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "analytic/configuration_factors.h"
#include "exitance/formfactor/point_polygon.h"
#include "exitance/formfactor/point_polygon_block.h"
#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

using analytic::parallel_rectangle;
using analytic::perpendicular_rectangle;

constexpr double pi = std::numbers::pi;
const Vec3 up{0, 0, 1}, down{0, 0, -1};

Vec3 random_direction(std::uint64_t key) {
    const double z = 2 * uniform(key, 0) - 1, phi = 2 * pi * uniform(key, 1);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// [x0, x1] × [y0, y1] at height z, facing down.
std::array<Vec3, 4> ceiling(double x0, double x1, double y0, double y1, double z) {
    return {{{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}};
}

// A convex planar polygon of `n` corners on a circle, in no special place.
std::vector<Vec3> random_polygon(std::uint64_t key, std::size_t n) {
    const Vec3 centre = random_direction(key) * (0.5 + 4 * uniform(key, 9));
    const Frame frame(random_direction(key + 1));
    const double radius = 0.2 + 2 * uniform(key, 10), stretch = 0.3 + 0.7 * uniform(key, 11);
    std::vector<double> angles(n);
    for (std::size_t i = 0; i < n; ++i)
        angles[i] = 2 * pi * (double(i) + 0.8 * uniform(key, 20 + i)) / double(n);
    std::vector<Vec3> corners;
    for (const double a : angles)
        corners.push_back(centre + frame.tangent * (radius * std::cos(a)) +
                          frame.bitangent * (radius * stretch * std::sin(a)));
    return corners;
}

// The float kernel for one receiver.
float block_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners,
                   const Vec3& middle = {}) {
    std::array<Vec3, 4> four{};
    std::copy(corners.begin(), corners.end(), four.begin());
    Receivers receivers;
    receivers.add(point - middle, normal, 0);
    const std::uint32_t which = 0;
    ReceiverBlock block;
    block.load(receivers, &which, 1);
    alignas(64) std::array<float, ReceiverBlock::capacity> factors;
    point_polygon_factors(block, Source(four, static_cast<std::uint32_t>(corners.size()), middle),
                          0.0f, factors.data());
    return factors[0];
}

// Both kernels against an exact value; float keeps 1e-4 of it (point_polygon_block.h).
void expect_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners,
                   double exact) {
    EXPECT_NEAR(point_polygon_factor(point, normal, corners), exact, 1e-12 + 1e-11 * exact);
    if (corners.size() <= 4) {
        EXPECT_NEAR(double(block_factor(point, normal, corners)), exact, 1e-6 + 1e-4 * exact);
    }
}

TEST(PointPolygon, ParallelRectangleAboveItsCorner) {  // Howell B-3
    for (const double a : {0.1, 1.0, 7.0})
        for (const double b : {0.2, 1.0, 5.0})
            for (const double c : {0.05, 1.0, 10.0})
                expect_factor({}, up, ceiling(0, a, 0, b, c), parallel_rectangle(a, b, c));
}

TEST(PointPolygon, ParallelRectangleAnywhere) {
    for (const double x : {-3.0, -0.5, 0.0, 0.4, 1.0, 2.5})
        for (const double y : {-1.0, 0.0, 0.3, 2.0})
            expect_factor({x, y, 0}, up, ceiling(0, 1, 0, 1.5, 0.7),
                          parallel_rectangle(-x, 1 - x, -y, 1.5 - y, 0.7));
}

TEST(PointPolygon, PerpendicularRectangleAtItsFoot) {  // Howell B-4
    for (const double a : {0.1, 1.0, 8.0})
        for (const double b : {0.3, 1.0, 4.0})
            for (const double c : {0.01, 0.5, 3.0}) {
                const std::array<Vec3, 4> wall{{{c, 0, 0}, {c, 0, a}, {c, b, a}, {c, b, 0}}};
                expect_factor({}, up, wall, perpendicular_rectangle(a, b, c));
            }
}

TEST(PointPolygon, DiscByAFinePolygon) {
    // Facing disc on the axis: r² / (r² + h²). The regular polygon with the area of the disc has
    // the same factor to O(n⁻⁴), here 1e-9.
    constexpr std::size_t n = 512;
    for (const double r : {0.1, 1.0, 3.0})
        for (const double h : {0.2, 1.0}) {
            const double R = r * std::sqrt(2 * pi / n / std::sin(2 * pi / n));
            std::vector<Vec3> disc;
            for (std::size_t i = 0; i < n; ++i)
                disc.push_back({R * std::cos(2 * pi * double(i) / n),
                                -R * std::sin(2 * pi * double(i) / n), h});
            EXPECT_NEAR(point_polygon_factor({}, up, disc), r * r / (r * r + h * h), 1e-8);
            // Tilted by 60° and wholly above the horizon, the factor is the cosine of it.
            if (h > 2 * r) {
                EXPECT_NEAR(point_polygon_factor({}, {std::sqrt(0.75), 0, 0.5}, disc),
                            0.5 * r * r / (r * r + h * h), 1e-8);
            }
        }
}

TEST(PointPolygon, HorizonCutsThePolygon) {
    // A wall that reaches from -1 to 1 is lit only from its upper half.
    const std::array<Vec3, 4> whole{{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}};
    expect_factor({}, up, whole, 2 * perpendicular_rectangle(1, 1, 1));
    // However far it reaches below.
    const std::array<Vec3, 4> deep{{{1, -1, -50}, {1, -1, 1}, {1, 1, 1}, {1, 1, -50}}};
    expect_factor({}, up, deep, 2 * perpendicular_rectangle(1, 1, 1));
    // Seen upside down: the lower half.
    expect_factor({}, down, whole, 2 * perpendicular_rectangle(1, 1, 1));
}

TEST(PointPolygon, CornersAndEdgesExactlyOnTheHorizon) {
    const std::array<Vec3, 4> resting{{{1, -1, 0}, {1, -1, 1}, {1, 1, 1}, {1, 1, 0}}};
    expect_factor({}, up, resting, 2 * perpendicular_rectangle(1, 1, 1));
    // Diamond with two corners on the horizon, one above, one below: as the triangle above.
    const std::array<Vec3, 4> diamond{{{1, -1, 0}, {1, 0, 1}, {1, 1, 0}, {1, 0, -1}}};
    const std::array<Vec3, 3> above{{{1, -1, 0}, {1, 0, 1}, {1, 1, 0}}};
    const double exact = point_polygon_factor({}, up, above);
    EXPECT_GT(exact, 0.05);
    expect_factor({}, up, diamond, exact);
    // One corner touches the horizon from below.
    const std::array<Vec3, 3> hanging{{{1, -1, -1}, {1, 0, 0}, {1, 1, -1}}};
    expect_factor({}, up, hanging, 0);
    // One corner touches it from above.
    const std::array<Vec3, 3> standing{{{1, 0, 0}, {1, -1, 1}, {1, 1, 1}}};
    const std::array<Vec3, 3> raised{{{1, 0, 1e-9}, {1, -1, 1}, {1, 1, 1}}};
    EXPECT_NEAR(point_polygon_factor({}, up, standing), point_polygon_factor({}, up, raised), 1e-8);
    expect_factor({}, up, standing, point_polygon_factor({}, up, standing));
}

TEST(PointPolygon, BehindIsDark) {
    const auto above = ceiling(-1, 1, -1, 1, 1);
    expect_factor({0, 0, 2}, down, above, 0);      // behind the polygon
    expect_factor({0, 0, 0}, down, above, 0);      // turned away
    expect_factor({0.3, 0.2, 1}, down, above, 0);  // on it
    expect_factor({3, 0, 1}, down, above, 0);      // in its plane
    expect_factor({3, 0, 1}, up, above, 0);
}

TEST(PointPolygon, FootOfAWallIsTheLimitFromInside) {
    // A hair in front of an infinitely long wall a floor point gets half of it, Howell B-4.
    for (const double gap : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const std::array<Vec3, 4> wall{{{0, -1, 0}, {0, 1, 0}, {0, 1, 2}, {0, -1, 2}}};
        expect_factor({gap, 0.3, 0}, up, wall,
                      perpendicular_rectangle(2, 0.7, gap) + perpendicular_rectangle(2, 1.3, gap));
    }
}

TEST(PointPolygon, OnTheCommonEdgeNothingIsUndefined) {
    const std::array<Vec3, 4> wall{{{0, -1, 0}, {0, 1, 0}, {0, 1, 2}, {0, -1, 2}}};
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 5, 0}}) {
        EXPECT_EQ(point_polygon_factor(p, up, wall), 0) << "in the plane: the factor is 0";
        EXPECT_EQ(block_factor(p, up, wall), 0.0f);
    }
}

RC_GTEST_PROP(PointPolygon, IsBetweenNoneAndAll, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto polygon = random_polygon(key, 3 + key % 4);
    const double F =
        point_polygon_factor(random_direction(key + 2), random_direction(key + 3), polygon);
    RC_ASSERT(F >= 0 && F <= 1);
}

RC_GTEST_PROP(PointPolygon, SurvivesMovingTurningAndScaling, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    auto polygon = random_polygon(key, 3 + key % 3);
    const Vec3 point = random_direction(key + 2), normal = random_direction(key + 3);
    const double before = point_polygon_factor(point, normal, polygon);
    const Frame turn(random_direction(key + 4));
    const double scale = std::exp(10 * uniform(key, 5) - 5);
    const Vec3 shift = random_direction(key + 6) * 5;
    const auto move = [&](const Vec3& p) { return shift + turn.to_world(p) * scale; };
    for (Vec3& p : polygon) p = move(p);
    RC_ASSERT(std::abs(point_polygon_factor(move(point), turn.to_world(normal), polygon) - before) <
              1e-10 / std::min(1.0, scale));
}

RC_GTEST_PROP(PointPolygon, PartsAddUp, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto polygon = random_polygon(key, 4);
    const Vec3 point = random_direction(key + 2), normal = random_direction(key + 3);
    const auto at = [&](double s, double t) {  // bilinear
        return (polygon[0] * (1 - s) + polygon[1] * s) * (1 - t) +
               (polygon[3] * (1 - s) + polygon[2] * s) * t;
    };
    double sum = 0, block_sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) {
            const std::array<Vec3, 4> part{at(i / 3.0, j / 2.0), at((i + 1) / 3.0, j / 2.0),
                                           at((i + 1) / 3.0, (j + 1) / 2.0),
                                           at(i / 3.0, (j + 1) / 2.0)};
            sum += point_polygon_factor(point, normal, part);
            block_sum += double(block_factor(point, normal, part));
        }
    const double whole = point_polygon_factor(point, normal, polygon);
    RC_ASSERT(std::abs(sum - whole) < 1e-11);
    RC_ASSERT(std::abs(block_sum - whole) < 1e-6 + 1e-4 * whole);
}

RC_GTEST_PROP(PointPolygon, ConvexPolygonsAreSumsOfTriangles, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    const auto polygon = random_polygon(key, 7);
    const Vec3 point = random_direction(key + 2), normal = random_direction(key + 3);
    double sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum +=
            point_polygon_factor(point, normal, std::array{polygon[0], polygon[i - 1], polygon[i]});
    RC_ASSERT(std::abs(sum - point_polygon_factor(point, normal, polygon)) < 1e-11);
}

// The accuracy that point_polygon_block.h states, over sizes, distances and directions: what is
// small, far away, close, grazing, cut by the horizon. Geometry is rounded to float first, so that
// only the kernel's own arithmetic is judged.
TEST(PointPolygonBlock, IsAsAccurateAsItSays) {
    const auto rounded = [](const Vec3& v) { return Vec3(Vec3f(v)); };
    int faint = 0, strong = 0;
    for (std::uint64_t key = 0; key < 40'000; ++key) {
        auto polygon = random_polygon(hash_bits(key), 3 + key % 2);
        const double distance = std::exp(7 * uniform(hash_bits(key), 40) - 1.5);
        const Vec3 point = rounded(random_direction(hash_bits(key) + 2) * distance);
        const Vec3 normal = rounded(random_direction(hash_bits(key) + 3));
        for (Vec3& p : polygon) p = rounded(p);
        // At the polygon's plane the factor depends on how the plane itself was rounded.
        const double height = std::abs(dot(unit_normal(polygon), point - polygon[0]));
        if (height < 1e-2 * length(point - centroid(polygon))) continue;
        const double exact = point_polygon_factor(point, normal, polygon);
        EXPECT_NEAR(double(block_factor(point, normal, polygon)), exact,
                    std::max(5e-8, 1e-4 * exact))
            << key << " distance " << distance;
        ++(exact > 5e-4 ? strong : faint);
    }
    EXPECT_GT(strong, 3000);
    EXPECT_GT(faint, 3000);
}

TEST(PointPolygonBlock, FillsWholeBlocksOfAnySize) {
    const auto polygon = ceiling(-1, 1, -1, 1, 1);
    Receivers receivers;
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < ReceiverBlock::capacity; ++i) {
        receivers.add({uniform(1, i) * 4 - 2, uniform(2, i) * 4 - 2, 0}, up, i);
        which.push_back(ReceiverBlock::capacity - 1 - i);
    }
    for (const std::size_t n : {1u, 15u, 16u, 17u, 100u, 256u}) {
        ReceiverBlock block;
        block.load(receivers, which.data(), n);
        alignas(64) std::array<float, ReceiverBlock::capacity> factors;
        point_polygon_factors(block, Source(polygon, 4, {}), 0.0f, factors.data());
        for (std::size_t r = 0; r < n; ++r) {
            const Vec3 p(receivers.x[which[r]], receivers.y[which[r]], 0);
            const double exact = point_polygon_factor(p, up, polygon);
            EXPECT_NEAR(double(factors[r]), exact, 1e-5 * exact) << n;
        }
    }
}

// From any place on the inside of a closed box every direction meets a wall: the factors to all
// walls sum to 1.
class Closure : public ::testing::TestWithParam<double> {};

TEST_P(Closure, OfABox) {
    const double gap = GetParam();  // from the nearest edges
    const double x = 2, y = 1, z = 0.5;
    const std::vector<std::array<Vec3, 4>> walls{{{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}}},
                                                 {{{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}}},
                                                 {{{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}}},
                                                 {{{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}}},
                                                 {{{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}}},
                                                 {{{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}}}};
    const std::vector<std::pair<Vec3, Vec3>> places{
        {{gap, gap, 0}, {0, 0, 1}},       {{x / 2, gap, 0}, {0, 0, 1}},
        {{x - gap, y / 3, 0}, {0, 0, 1}}, {{gap, y / 2, z}, {0, 0, -1}},
        {{0, gap, gap}, {1, 0, 0}},       {{x / 3, y, z - gap}, {0, -1, 0}}};
    for (const auto& [p, n] : places) {
        double sum = 0, block_sum = 0;
        for (const auto& wall : walls) {
            sum += point_polygon_factor(p, n, wall);
            block_sum += double(block_factor(p, n, wall, {x / 2, y / 2, z / 2}));
        }
        EXPECT_NEAR(sum, 1, 1e-12) << "gap " << gap;
        // Coordinates in float are 1e-7 of the box off, as seen from `gap` away.
        EXPECT_NEAR(block_sum, 1, 2e-6 + 2e-7 / gap) << "gap " << gap;
    }
}

INSTANTIATE_TEST_SUITE_P(Near, Closure, ::testing::Values(0.25, 0.1, 1e-2, 1e-3, 1e-4));

}  // namespace
}  // namespace exitance
