// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/column.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "analytic/configuration_factors.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

using analytic::parallel_rectangle;

// A lamp [-1,1]² at z = 2 over a floor, a blocker [-0.4,0.4]² between them at z = 1.
struct Stage {
    std::vector<Vec3> points{{-1, -1, 2},     {-1, 1, 2},     {1, 1, 2},     {1, -1, 2},
                             {-0.4, -0.4, 1}, {0.4, -0.4, 1}, {0.4, 0.4, 1}, {-0.4, 0.4, 1}};
    std::vector<RayCaster::Face> faces{{0, 1, 2, 3}, {4, 5, 6, 7}};
    RayCaster caster{points, faces};
    Source lamp{{points[0], points[1], points[2], points[3]}, 4, caster.middle()};
    Receivers receivers;
    std::vector<std::uint32_t> everyone;

    Stage() {
        for (std::uint32_t i = 0; i < 3000; ++i) {
            receivers.add(place(i) - caster.middle(), {0, 0, 1}, i);
            everyone.push_back(i);
        }
    }
    static Vec3 place(std::uint32_t i) { return {6 * uniform(1, i) - 3, 6 * uniform(2, i) - 3, 0}; }
    // The square covers [-0.8 - x, 0.8 - x] of the lamp's plane, see tests/analytic.
    static double whole(const Vec3& p) {
        return parallel_rectangle(-1 - p.x, 1 - p.x, -1 - p.y, 1 - p.y, 2);
    }
    static double hidden(const Vec3& p) {
        const double x0 = std::clamp(-0.8 - p.x, -1.0, 1.0), x1 = std::clamp(0.8 - p.x, -1.0, 1.0);
        const double y0 = std::clamp(-0.8 - p.y, -1.0, 1.0), y1 = std::clamp(0.8 - p.y, -1.0, 1.0);
        return parallel_rectangle(x0 - p.x, x1 - p.x, y0 - p.y, y1 - p.y, 2);
    }
    std::vector<ColumnEntry> column(float brightness, const ColumnOptions& options,
                                    std::uint64_t& rays, std::uint32_t number = 0) const {
        std::vector<ColumnEntry> entries(everyone.size());
        rays =
            compute_column(caster, lamp, brightness, number, receivers, everyone, options, entries);
        return entries;
    }
};

TEST(Column, MatchesTheClosedFormWithinItsTolerance) {
    const Stage stage;
    for (const float brightness : {30.0f, 300.0f}) {
        std::uint64_t rays = 0;
        const auto entries = stage.column(brightness, {}, rays);
        double square = 0, largest = 0, bias = 0;
        int shaded = 0;
        for (std::uint32_t i = 0; i < entries.size(); ++i) {
            const Vec3 p = Stage::place(i);
            const double whole = Stage::whole(p), hidden = Stage::hidden(p);
            EXPECT_NEAR(double(entries[i].factor), whole, 1e-4 * whole);
            // `brightness` is in units of the error that may remain: so is this.
            const double error =
                double(brightness) * (double(entries[i].received()) - (whole - hidden));
            if (hidden == 0) {
                EXPECT_EQ(entries[i].visible, 1.0f);
                continue;
            }
            ++shaded;
            square += error * error, bias += error;
            largest = std::max(largest, std::abs(error));
        }
        ASSERT_GT(shaded, 500);
        EXPECT_LT(std::sqrt(square / shaded), 1) << "RMS in tolerances, brightness " << brightness;
        EXPECT_LT(std::abs(bias / shaded), 0.1) << "slivers that the probes miss";
        EXPECT_LT(largest, 15) << "a probe that misses the edge of a shadow may be off by more";
    }
}

TEST(Column, BrighterSourcesGetMoreRays) {
    const Stage stage;
    std::uint64_t faint = 0, middling = 0, bright = 0;
    stage.column(0.1f, {}, faint);
    stage.column(30, {}, middling);
    stage.column(3000, {}, bright);
    EXPECT_EQ(faint, stage.everyone.size()) << "one ray each";
    EXPECT_GT(middling, faint);
    EXPECT_GT(bright, 2 * middling);
    EXPECT_LE(bright, 256 * stage.everyone.size());
}

TEST(Column, WithoutOcclusionNoRayIsCast) {
    const Stage stage;
    ColumnOptions options;
    options.occlusion = false;
    std::uint64_t rays = 1;
    for (const ColumnEntry& e : stage.column(300, options, rays)) EXPECT_EQ(e.visible, 1.0f);
    EXPECT_EQ(rays, 0u);
}

TEST(Column, DiskAgreesWithLambertWithinItsAccuracy) {
    // The lamp is half as wide as it is far, where discs around 30 or more samples are 2 % off.
    const Stage stage;
    ColumnOptions options;
    options.factor = PointFactor::disk;
    std::uint64_t rays = 0;
    const auto entries = stage.column(3000, options, rays);
    double worst = 0;
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        const Vec3 p = Stage::place(i);
        const double exact = Stage::whole(p) - Stage::hidden(p);
        worst = std::max(worst, std::abs(double(entries[i].received()) - exact));
    }
    EXPECT_LT(worst, 0.02 * Stage::whole({}));
    options.occlusion = false;
    std::uint64_t none = 1;
    const auto open = stage.column(3000, options, none);
    EXPECT_EQ(none, 0u);
    for (std::uint32_t i = 0; i < open.size(); ++i) {
        const double exact = Stage::whole(Stage::place(i));
        EXPECT_NEAR(double(open[i].received()), exact, 0.03 * exact);
    }
}

TEST(Column, BehindTheSourceIsDarkAndCostsNothing) {
    const Stage stage;
    Receivers behind;
    std::vector<std::uint32_t> which;
    for (std::uint32_t i = 0; i < 100; ++i) {
        behind.add(Vec3{0.01 * i, 0, 3} - stage.caster.middle(), {0, 0, -1}, i);
        which.push_back(i);
    }
    std::vector<ColumnEntry> entries(which.size());
    EXPECT_EQ(compute_column(stage.caster, stage.lamp, 100, 0, behind, which, {}, entries), 0u);
    for (const ColumnEntry& e : entries) EXPECT_EQ(e.received(), 0.0f);
}

TEST(Column, IsTheSameOnAnyNumberOfThreads) {
    const Stage stage;
    const auto run = [&](std::size_t threads, std::uint64_t& rays) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return stage.column(300, {}, rays);
    };
    std::uint64_t one_rays = 0, two_rays = 0;
    const auto one = run(1, one_rays), two = run(2, two_rays);
    EXPECT_EQ(one_rays, two_rays);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].factor, two[i].factor);
        EXPECT_EQ(one[i].visible, two[i].visible);
    }
}

TEST(Column, SeedAndNumberChangeTheSamples) {
    const Stage stage;
    std::uint64_t rays = 0;
    const auto base = stage.column(300, {}, rays);
    ColumnOptions other;
    other.seed = 1;
    const auto seeded = stage.column(300, other, rays), numbered = stage.column(300, {}, rays, 1);
    int by_seed = 0, by_number = 0;
    for (std::size_t i = 0; i < base.size(); ++i) {
        by_seed += base[i].visible != seeded[i].visible;
        by_number += base[i].visible != numbered[i].visible;
    }
    EXPECT_GT(by_seed, 100);
    EXPECT_GT(by_number, 100);
}

TEST(Column, TakesReceiversInAnyOrder) {
    const Stage stage;
    std::uint64_t rays = 0;
    const auto all = stage.column(300, {}, rays);
    const std::vector<std::uint32_t> some{2999, 5, 700, 5};
    std::vector<ColumnEntry> entries(some.size());
    compute_column(stage.caster, stage.lamp, 300, 0, stage.receivers, some, {}, entries);
    for (std::size_t i = 0; i < some.size(); ++i) {
        EXPECT_EQ(entries[i].factor, all[some[i]].factor);
        EXPECT_EQ(entries[i].visible, all[some[i]].visible);
    }
}

}  // namespace
}  // namespace exitance
