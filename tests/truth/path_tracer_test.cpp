// SPDX-License-Identifier: Apache-2.0
// The truth itself is judged by closed forms. Tolerances are five standard errors as the path
// tracer states them, and the stated errors are held to a bound so that they cannot hide a fault.
#include "truth/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/math/polygon.h"

namespace exitance::truth {
namespace {

Material surface_of(double reflectance, double exitance, bool two_sided = false) {
    Material m;
    m.reflectance = {reflectance, reflectance / 2, 0};
    m.exitance = {exitance, exitance, 2 * exitance};
    m.two_sided = two_sided;
    return m;
}

std::uint32_t add_polygon(Scene& scene, const Material& material, std::vector<Vec3> corners,
                          const std::string& name = "") {
    const std::uint32_t surface = scene.add_surface(name, scene.add_material(material));
    Polygon polygon;
    polygon.surface = surface;
    for (std::size_t i = 0; i < corners.size(); ++i)
        polygon.corners[i] = scene.add_point(corners[i]);
    scene.polygons.push_back(polygon);
    return surface;
}

/// Axis-aligned box seen from inside.
Scene room(const Vec3& size, const Material& material) {
    const auto [x, y, z] = size;
    Scene scene;
    add_polygon(scene, material, {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}});
    add_polygon(scene, material, {{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}});
    add_polygon(scene, material, {{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}});
    add_polygon(scene, material, {{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}});
    add_polygon(scene, material, {{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}});
    add_polygon(scene, material, {{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}});
    return scene;
}

void expect_truth(const Estimate& e, std::size_t receiver, std::size_t column, double exact,
                  double largest_error) {
    const double error = e.error_at(receiver, column);
    EXPECT_LE(error, largest_error * exact) << "receiver " << receiver << " column " << column;
    EXPECT_NEAR(e.at(receiver, column), exact, 5 * error + 1e-6 * exact)
        << "receiver " << receiver << " column " << column;
}

TEST(PathTracer, ClosedBoxIsUniform) {
    for (const double rho : {0.5, 0.95}) {
        const Scene scene = room({1, 2, 0.5}, surface_of(rho, 3));
        const std::vector<Receiver> receivers{{{0.5, 1, 0}, {0, 0, 1}},
                                              {{1e-4, 1e-4, 0}, {0, 0, 1}},       // a corner
                                              {{1, 1e-3, 0.25}, {-1, 0, 0}},      // an edge
                                              {{0.3, 0.3, 0.3}, {0.6, 0, 0.8}}};  // free space
        const Estimate e = PathTracer(scene).irradiance(receivers, {256, 16, 1});
        for (std::size_t p = 0; p < receivers.size(); ++p) {
            expect_truth(e, p, 0, 3 / (1 - rho), 0.02);
            expect_truth(e, p, 1, 3 / (1 - rho / 2), 0.02);
            expect_truth(e, p, 2, 6, 3e-3);
        }
    }
}

TEST(PathTracer, SphereInteriorHasTheSameIrradianceEverywhere) {
    // In a sphere every point sees dA' with the factor dA'/A, so H = ⟨E⟩ / (1 − ⟨ρ⟩) everywhere
    // (averages by area). The chords of 24 × 48 facets depart from the sphere by 0.3 %.
    Scene scene;
    constexpr std::uint32_t rows = 24, columns = 48;
    double area_sum = 0, E = 0, rho = 0;
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        const double theta = std::numbers::pi * i / rows;
        const double phi = 2 * std::numbers::pi * (j % columns) / columns;
        const double ring = i == 0 || i == rows ? 0.0 : std::sin(theta);
        return Vec3{ring * std::cos(phi), ring * std::sin(phi), std::cos(theta)};
    };
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            const double r = 0.1 + 0.8 * ((i * 7 + j * 3) % 11) / 10.0;
            const double e = (i * 5 + j) % 7 == 0 ? 4.0 : 0.0;
            std::vector<Vec3> corners{at(i, j), at(i, j + 1)};
            if (i + 1 < rows) corners.push_back(at(i + 1, j + 1));
            if (i > 0 || i + 1 == rows) corners.push_back(at(i + 1, j));
            if (i == 0) corners = {at(0, 0), at(1, j + 1), at(1, j)};
            const double A = area(corners);
            ASSERT_GT(dot(unit_normal(corners), -centroid(corners)), 0);
            area_sum += A, E += e * A, rho += r * A;
            add_polygon(scene, surface_of(r, e), corners);
        }
    const double exact = E / area_sum / (1 - rho / area_sum);
    const Estimate e = PathTracer(scene).irradiance(
        std::vector<Receiver>{{{0.0, 0.0, -0.99}, {0, 0, 1}}, {{0.6, 0.0, 0.79}, {-0.6, 0, -0.8}}},
        {512, 16, 2});
    for (std::size_t p = 0; p < 2; ++p) {
        EXPECT_LE(e.error_at(p), 0.01 * exact);
        EXPECT_NEAR(e.at(p), exact, 5 * e.error_at(p) + 0.01 * exact);
    }
}

TEST(PathTracer, PointUnderSquareLamp) {
    // Point below the corner of an a × b rectangle at distance c (Hottel's configuration factor):
    // F = (1/2π) [A/√(1+A²) atan(B/√(1+A²)) + B/√(1+B²) atan(A/√(1+B²))], A = a/c, B = b/c.
    Scene scene;
    add_polygon(scene, surface_of(0, 10), {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
    const double A = 0.5, w = std::sqrt(1 + A * A);
    const double exact = 4 * 10 * (2 * A / w * std::atan(A / w)) / (2 * std::numbers::pi);
    const Estimate e = PathTracer(scene).irradiance(
        std::vector<Receiver>{
            {{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}, {{0, 0, 4}, {0, 0, -1}}},
        {1024, 16, 3});
    expect_truth(e, 0, 0, exact, 1e-3);
    EXPECT_EQ(e.at(1), 0) << "the side that faces away";
    EXPECT_EQ(e.at(2), 0) << "the lamp's black back";
}

TEST(PathTracer, TexelMeanIsTheFactorBetweenRectangles) {
    // Equal squares face to face at the distance of their side: F = 0.199825 (Howell C-11).
    Scene scene;
    add_polygon(scene, surface_of(0, 1), {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
    const SensorGrid grid{"floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1};
    const Estimate e = PathTracer(scene).irradiance(texels_of(grid), {1024, 16, 4});
    EXPECT_LE(e.error_at(0), 1e-3);
    EXPECT_NEAR(e.at(0), 0.199825, 5 * e.error_at(0) + 1e-6);
}

TEST(PathTracer, SidesOfASheetBetweenTwoLamps) {
    // A large sheet midway between large lamps of exitance 1 above and 2 below, the lamps two-sided
    // or not must not matter to it; what it reflects depends on its sides.
    const double size = 1000;
    const auto scene_with = [&](bool two_sided) {
        Scene scene;
        const double s = size;
        add_polygon(scene, surface_of(0, 1), {{-s, -s, 1}, {-s, s, 1}, {s, s, 1}, {s, -s, 1}});
        add_polygon(scene, surface_of(0, 2), {{-s, -s, -1}, {s, -s, -1}, {s, s, -1}, {-s, s, -1}});
        add_polygon(scene, surface_of(0.5, 0, two_sided),
                    {{-s, -s, 0}, {s, -s, 0}, {s, s, 0}, {-s, s, 0}});
        return scene;
    };
    // From just under a lamp, looking at the sheet: 0.5 × what falls on that side of it.
    const std::vector<Receiver> receivers{
        {{0, 0, 0.5}, {0, 0, -1}}, {{0, 0, -0.5}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}};
    const Estimate one = PathTracer(scene_with(false)).irradiance(receivers, {1024, 16, 5});
    const Estimate two = PathTracer(scene_with(true)).irradiance(receivers, {1024, 16, 5});
    const auto near = [](double got, double exact) { EXPECT_NEAR(got, exact, 0.01 * exact); };
    near(one.at(0), 0.5);
    EXPECT_EQ(one.at(1), 0) << "a one-sided back is black";
    near(two.at(0), 0.5);
    near(two.at(1), 1.0);
    near(one.at(2), 2.0);
}

TEST(PathTracer, TwoSidedEmitterShinesBothWays) {
    Scene scene;
    add_polygon(scene, surface_of(0, 1, true), {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
    const Estimate e = PathTracer(scene).irradiance(
        std::vector<Receiver>{{{0.5, 0.5, 0}, {0, 0, 1}}, {{0.5, 0.5, 2}, {0, 0, -1}}},
        {1024, 16, 6});
    EXPECT_NEAR(e.at(0), e.at(1), 5 * (e.error_at(0) + e.error_at(1)));
    EXPECT_GT(e.at(0), 0.2);
}

TEST(PathTracer, GroupsAddUpToAllLight) {
    Scene scene = room({1, 1, 1}, surface_of(0.6, 0));
    add_polygon(scene, surface_of(0, 20), {{.2, .2, .9}, {.2, .4, .9}, {.4, .4, .9}, {.4, .2, .9}},
                "left");
    add_polygon(scene, surface_of(0, 5), {{.6, .6, .9}, {.6, .8, .9}, {.8, .8, .9}, {.8, .6, .9}},
                "right");
    const std::vector<Receiver> receivers{{{0.3, 0.3, 0}, {0, 0, 1}}, {{0, 0.5, 0.5}, {1, 0, 0}}};
    const PathTracer apart(scene, Grouping::luminaire);
    ASSERT_EQ(apart.groups().groups.size(), 2u);
    const Estimate e = apart.irradiance(receivers, {256, 16, 7});
    const Estimate all = PathTracer(scene).irradiance(receivers, {256, 16, 7});
    for (std::size_t p = 0; p < 2; ++p)
        for (std::size_t b = 0; b < 3; ++b)
            EXPECT_NEAR(e.at(p, b) + e.at(p, 3 + b), all.at(p, b), 1e-9 * all.at(p, b));
    EXPECT_GT(e.at(0, 0), e.at(0, 3)) << "below the left lamp its light is stronger";
}

TEST(PathTracer, StatedErrorIsTheSpreadOfSeeds) {
    const Scene scene = room({1, 1, 1}, surface_of(0.5, 1));
    std::vector<Receiver> receivers(64, Receiver{{0.4, 0.3, 0}, {0, 0, 1}});
    const Estimate e = PathTracer(scene).irradiance(receivers, {64, 16, 8});
    double mean = e.average(0), spread = 0;
    for (std::size_t p = 0; p < receivers.size(); ++p) spread += std::pow(e.at(p) - mean, 2);
    spread = std::sqrt(spread / 63);
    // 64 values give a spread to 9 %, 64 × 15 degrees of freedom the stated error to 2 %.
    EXPECT_NEAR(spread / e.rms_error(0), 1, 0.35);
}

}  // namespace
}  // namespace exitance::truth
