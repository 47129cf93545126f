// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pairwise.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "exitance/formfactor/polygon_polygon.h"
#include "exitance/math/frame.h"
#include "exitance/run/error.h"
#include "exitance/run/random.h"
#include "formfactor/view_factor_cases.h"

namespace exitance {
namespace {

using namespace view_factors;

double factor(const Enclosure& enclosure, const ExchangeAreas& areas, std::size_t i,
              std::size_t j) {
    return areas.at(i, j) / enclosure.surfaces[i].area;
}

std::vector<double> row_sums(const Enclosure& enclosure, const ExchangeAreas& areas) {
    std::vector<double> sums(areas.rows());
    for (std::size_t i = 0; i < areas.rows(); ++i)
        areas.visit_row(i, [&](std::size_t j, float area) {
            sums[i] += double(area) / enclosure.surfaces[i].area;
            if (j != i) sums[j] += double(area) / enclosure.surfaces[j].area;
        });
    return sums;
}

/// Two unit squares at distance 1 and something square half way between them.
double past_a_square(double x0, double x1, double y0, double y1, double accuracy) {
    Enclosure enclosure;
    add_facet(enclosure, level(0, 1, 0, 1, 0, true));
    add_facet(enclosure, level(0, 1, 0, 1, 1, false));
    add_facet(enclosure, level(x0, x1, y0, y1, 0.5, true), true);
    return factor(enclosure, pairwise_exchange_areas(enclosure, {accuracy}), 0, 1);
}

TEST(Pairwise, SquaresWithASquareBetween) {
    // Quadrature of the closed form for a point over the shadow (Shapiro 1985; View3D's example).
    for (const double accuracy : {1e-4, 1e-5, 1e-6}) {
        EXPECT_NEAR(past_a_square(0.25, 0.75, 0.25, 0.75, accuracy), 0.09950629459898491, accuracy);
        EXPECT_NEAR(past_a_square(0, 0.5, 0, 0.5, accuracy), 0.14986867177379065, accuracy);
        EXPECT_NEAR(past_a_square(0.125, 0.875, 0.125, 0.875, accuracy), 0.029483544914760074,
                    accuracy);
    }
}

TEST(Pairwise, VeryMuchBetweenIsLookedPastByRays) {
    // The square of the case above in 100 pieces, each a little higher than the one before, so that
    // they stay apart: together they hide what it does, to some 1e-4.
    Enclosure enclosure;
    add_facet(enclosure, level(0, 1, 0, 1, 0, true));
    add_facet(enclosure, level(0, 1, 0, 1, 1, false));
    for (int k = 0; k < 100; ++k) {
        const double x = 0.25 + 0.05 * (k % 10), y = 0.25 + 0.05 * (k / 10);
        add_facet(enclosure, level(x, x + 0.05, y, y + 0.05, 0.5 + 1e-6 * k, true), true);
    }
    for (const double accuracy : {1e-2, 1e-3}) {
        PairwiseCounters counters;
        const auto areas = pairwise_exchange_areas(enclosure, {accuracy}, {}, nullptr, &counters);
        EXPECT_EQ(counters.sampled, 1u);
        EXPECT_GT(counters.rays, 0u);
        // A standard error; three of them and the steps.
        EXPECT_NEAR(factor(enclosure, areas, 0, 1), 0.09950629459898491, 3 * accuracy + 1e-4);
    }
}

TEST(Pairwise, ASheetAsLargeHidesAll) {
    EXPECT_EQ(past_a_square(-0.1, 1.1, -0.1, 1.1, 1e-4), 0);
}

TEST(Pairwise, ASheetBesideHidesNothing) {
    EXPECT_NEAR(past_a_square(1, 2, 0, 1, 1e-4), parallel(1, 1, 1), 1e-7);
}

TEST(Pairwise, CubeInACube) {
    // Outer face to the whole inner cube: A_inner / A_outer, for the inner one is convex; the four
    // perpendicular inner faces share what the facing one leaves (Howell C-13).
    for (const double s : {0.4, 0.6}) {
        Enclosure room;
        const double at = 0.5 * (1 - s);
        add_box(room, {0, 0, 0}, {1, 1, 1}, 1, true);
        add_box(room, {at, at, at}, {at + s, at + s, at + s}, 1, false);
        const auto areas = pairwise_exchange_areas(room, {1e-5});
        const double facing = offset_parallel({0, 1}, {0, 1}, {at, at + s}, {at, at + s}, at);
        double to_cube = 0, adjacent = 0;
        for (std::size_t j = 6; j < 12; ++j) to_cube += factor(room, areas, 0, j);
        for (std::size_t j = 2; j < 6; ++j) adjacent += factor(room, areas, 0, j) / 4;
        EXPECT_NEAR(to_cube, s * s, 1e-6);
        EXPECT_NEAR(factor(room, areas, 0, 6), facing, 1e-6);
        EXPECT_NEAR(factor(room, areas, 0, 8), (s * s - facing) / 4, 1e-6);
        EXPECT_NEAR(adjacent, (1 - s * s - factor(room, areas, 0, 1)) / 4, 1e-5);
        if (s == 0.6) {
            EXPECT_NEAR(factor(room, areas, 0, 1), 0.047419576114899775, 1e-5);
        }
        EXPECT_EQ(areas.at(6, 7), 0);
    }
}

TEST(Pairwise, ReferenceCases) {
    const auto file = std::filesystem::path(EXITANCE_SOURCE_DIR).parent_path() /
                      "shared/reference/view_factors.json";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const auto cases = nlohmann::json::parse(std::ifstream(file));
    int met = 0;
    for (const auto& one : cases) {
        const auto& geometry = one["geometry"];
        if (!geometry.contains("P1") || !geometry.contains("P2")) continue;
        const auto polygon = [&](const char* name) {
            std::vector<Vec3> corners;
            for (const auto& p : geometry[name]) corners.push_back({p[0], p[1], p[2]});
            return corners;
        };
        Enclosure enclosure;
        add_facet(enclosure, polygon("P1"));
        add_facet(enclosure, polygon("P2"));
        if (geometry.contains("occluder")) add_facet(enclosure, polygon("occluder"), true);
        const double exact = one["F12"];
        EXPECT_NEAR(factor(enclosure, pairwise_exchange_areas(enclosure, {1e-6}), 0, 1), exact,
                    one["obstructed"] ? 1e-5 : 1e-6)
            << one["name"];
        EXPECT_NEAR(factor(enclosure, pairwise_exchange_areas(enclosure, {}), 0, 1), exact, 1e-4)
            << one["name"];
        ++met;
    }
    EXPECT_GE(met, 18);
}

/// A closed room with a few boxes that do not touch.
Enclosure random_room(std::uint64_t key, std::size_t n) {
    Enclosure room;
    add_box(room, {0, 0, 0}, {1, 1, 1}, n, true);
    for (std::size_t c = 0; c < 8; ++c) {
        if (uniform(key, c) < 0.6) continue;
        const auto u = [&](std::size_t k) { return uniform(hash_bits(key, c), k); };
        const Vec3 cell{double(c % 2) / 2, double(c / 2 % 2) / 2, double(c / 4) / 2};
        const Vec3 low = cell + Vec3{0.02 + 0.15 * u(0), 0.02 + 0.15 * u(1), 0.02 + 0.15 * u(2)};
        add_box(room, low, low + Vec3{0.1 + 0.2 * u(3), 0.1 + 0.2 * u(4), 0.1 + 0.2 * u(5)}, 1,
                false);
    }
    return room;
}

RC_GTEST_PROP(Pairwise, ClosedRoomsAreClosed, ()) {
    const auto room = random_room(*rc::gen::arbitrary<std::uint64_t>(), 2);
    const auto areas = pairwise_exchange_areas(room, {1e-3});
    for (const double sum : row_sums(room, areas)) RC_ASSERT(std::abs(sum - 1) < 3e-3);
}

RC_GTEST_PROP(Pairwise, NothingIsSeenBetterThroughSomething, ()) {
    const auto room = random_room(*rc::gen::arbitrary<std::uint64_t>(), 1);
    const auto areas = pairwise_exchange_areas(room, {1e-3});
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double free =
                exchange_area(room.facets[i].corners(), room.facets[j].corners(), 1e-6);
            RC_ASSERT(areas.at(i, j) <= free * (1 + 1e-3) + 1e-9);
        }
}

RC_GTEST_PROP(Pairwise, SurvivesMovingTurningAndScaling, ()) {
    const auto key = *rc::gen::arbitrary<std::uint64_t>();
    auto room = random_room(key, 1);
    const auto before = pairwise_exchange_areas(room, {1e-3});
    const Frame turn(normalized(Vec3{uniform(key, 90) - 0.5, uniform(key, 91) - 0.5, 0.3}));
    const double scale = std::exp(6 * uniform(key, 92) - 3);
    for (Facet& facet : room.facets) {
        for (Vec3& p : facet.outline) p = Vec3{3, -2, 1} + turn.to_world(p) * scale;
        facet.normal = turn.to_world(facet.normal);
        facet.area *= scale * scale;
    }
    const auto after = pairwise_exchange_areas(room, {1e-3});
    for (std::size_t i = 0; i < before.rows(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            RC_ASSERT(std::abs(after.at(i, j) / (scale * scale) - before.at(i, j)) < 2e-3);
}

TEST(Pairwise, PartsOfARowAddUp) {
    // Each face of room and boxes one row of 4 × 4 facets, against the same faces whole.
    Enclosure whole = random_room(3, 1), parts;
    for (const Facet& face : whole.facets) {
        const Vec3 u = (face.outline[1] - face.outline[0]) / 4.0,
                   v = (face.outline[3] - face.outline[0]) / 4.0;
        for (int k = 0; k < 16; ++k) {
            const Vec3 at = face.outline[0] + u * double(k % 4) + v * double(k / 4);
            add_facet(parts, Quad{at, at + u, at + u + v, at + v});
            parts.facets.back().row = face.row;
        }
    }
    parts.surfaces = whole.surfaces;
    const auto fine = pairwise_exchange_areas(parts, {1e-4});
    const auto coarse = pairwise_exchange_areas(whole, {1e-5});
    for (std::size_t i = 0; i < fine.rows(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NEAR(factor(whole, fine, i, j), factor(whole, coarse, i, j), 2e-4)
                << i << ' ' << j;
}

TEST(Pairwise, SheetsThatMeetAtTheirEdgesBlockAsOne) {
    // A thin L of two sheets in the way, each of two facets, against Monte Carlo: the shared lines
    // must neither leak nor count twice.
    Enclosure enclosure;
    add_facet(enclosure, level(0, 1, 0, 1, 0, true));
    add_facet(enclosure, level(0, 1, 0, 1, 1, false));
    add_facet(enclosure, level(0.2, 0.5, 0.3, 0.8, 0.5, true), true);
    add_facet(enclosure, level(0.5, 0.7, 0.3, 0.8, 0.5, true), true);
    add_facet(enclosure, Quad{{{0.7, 0.3, 0.5}, {0.7, 0.8, 0.5}, {0.7, 0.8, 0.7}, {0.7, 0.3, 0.7}}},
              true);
    double sum = 0;
    const std::uint32_t rays = 1u << 20;
    for (std::uint32_t k = 0; k < rays; ++k) {
        const Vec3 x{uniform(1, k), uniform(2, k), 0}, y{uniform(3, k), uniform(4, k), 1},
            d = y - x;
        const Vec3 at = x + d * 0.5;
        const bool flat = at.x > 0.2 && at.x < 0.7 && at.y > 0.3 && at.y < 0.8;
        const double t = (0.7 - x.x) / d.x;
        const Vec3 side = x + d * t;
        const bool upright =
            t > 0 && t < 1 && side.y > 0.3 && side.y < 0.8 && side.z > 0.5 && side.z < 0.7;
        if (!flat && !upright) sum += 1 / (dot(d, d) * dot(d, d) * std::numbers::pi);
    }
    EXPECT_NEAR(factor(enclosure, pairwise_exchange_areas(enclosure, {1e-5}), 0, 1), sum / rays,
                4e-4);  // four standard errors of a million rays
}

TEST(Pairwise, TwoSidedFacetsBlockOnce) {
    Enclosure enclosure;
    add_facet(enclosure, level(0, 1, 0, 1, 0, true));
    add_facet(enclosure, level(0, 1, 0, 1, 1, false));
    add_facet(enclosure, level(0.25, 0.75, 0.25, 0.75, 0.5, true));
    add_facet(enclosure, level(0.25, 0.75, 0.25, 0.75, 0.5, false));
    const auto areas = pairwise_exchange_areas(enclosure, {1e-5});
    EXPECT_NEAR(areas.at(0, 1), 0.09950629459898491, 1e-5);
    EXPECT_EQ(areas.at(2, 3), 0);
    EXPECT_EQ(areas.at(0, 2), 0);
    EXPECT_NEAR(areas.at(0, 3), offset_parallel({0, 1}, {0, 1}, {0.25, 0.75}, {0.25, 0.75}, 0.5),
                1e-6);
}

TEST(Pairwise, WhatABoxStandsOnIsCovered) {
    Enclosure room;
    add_box(room, {0, 0, 0}, {1, 1, 1}, 1, true);
    add_box(room, {0.3, 0.3, 0}, {0.7, 0.7, 0.5}, 1, false);
    const auto areas = pairwise_exchange_areas(room, {1e-4});
    const auto sums = row_sums(room, areas);
    EXPECT_NEAR(sums[4], 1 - 0.16, 2e-3) << "floor: covered where the box stands";
    EXPECT_EQ(sums[10], 0) << "underside";
    for (const std::size_t i : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 8u, 9u, 11u})
        EXPECT_NEAR(sums[i], 1, 2e-3) << i;
}

TEST(Pairwise, SameBytesForAnyNumberOfThreads) {
    const auto room = random_room(11, 4);
    std::vector<ExchangeAreas> found;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        found.push_back(pairwise_exchange_areas(room, {1e-3}));
    }
    for (std::size_t i = 0; i < found[0].rows(); ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            EXPECT_EQ(found[0].at(i, j), found[1].at(i, j));
            EXPECT_EQ(found[0].at(i, j), found[2].at(i, j));
        }
}

TEST(Pairwise, CountsWhatItDidAndStopsWhenAsked) {
    const auto room = random_room(5, 3);
    PairwiseCounters counters;
    int reports = 0;
    pairwise_exchange_areas(
        room, {}, [&](const Progress&) { ++reports; }, nullptr, &counters);
    EXPECT_GT(reports, 0);
    EXPECT_GT(counters.partial, 0u);
    EXPECT_GT(counters.viewpoints, counters.partial);
    EXPECT_GE(counters.pairs,
              counters.partial + counters.hidden + counters.visible + counters.separated);
    Cancel cancel;
    cancel.request();
    EXPECT_THROW(pairwise_exchange_areas(room, {}, {}, &cancel), Error);
}

TEST(Pairwise, NothingAndAlmostNothing) {
    EXPECT_EQ(pairwise_exchange_areas({}, {}).rows(), 0u);
    Enclosure one;
    add_facet(one, level(0, 1, 0, 1, 0, true));
    EXPECT_EQ(pairwise_exchange_areas(one, {}).at(0, 0), 0);
}

}  // namespace
}  // namespace exitance
