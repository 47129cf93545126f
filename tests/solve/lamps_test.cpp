// SPDX-License-Identifier: Apache-2.0
// Many lamps: what they send unblocked is exact, and those that matter little look for what is in
// the way together.
#include "exitance/solve/lamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/solve/cast_emission.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;

constexpr int across = 12;

/// Under 144 lamps stands a block. `group_size` neighbouring lamps make a light group.
Scene hall(int group_size) {
    Scene scene;
    add_room(scene, {}, {12, 12, 3}, 0.5);
    add_block(scene, {5, 5, 0}, {8, 6, 2}, 0.5);
    for (int i = 0; i < across * across; ++i) {
        add_lamp(scene, "lamp " + std::to_string(i), {0.5 + i % across, 0.5 + i / across, 2.9}, 0.1,
                 {10.0 + i % 3, 10, 10});
        scene.materials.back().group = "group " + std::to_string(i / group_size);
    }
    return scene;
}

struct Stage {
    Scene scene;
    Radiosity radiosity;
    Lamps lamps;
    Receivers floor;
    std::vector<std::uint32_t> everyone;

    explicit Stage(int group_size)
        : scene(hall(group_size)),
          radiosity(scene, make_groups(scene, Grouping::file), MeshOptions::of_patches(1)),
          lamps(radiosity) {
        constexpr int places = 40;
        for (int i = 0; i < places * places; ++i)
            floor.add(Vec3{0.15 + 0.3 * (i % places), 0.15 + 0.3 * (i / places), 0} -
                          radiosity.caster.middle(),
                      {0, 0, 1}, static_cast<std::uint32_t>(i));
        everyone.resize(floor.size());
        std::iota(everyone.begin(), everyone.end(), 0u);
    }

    std::uint64_t cast(float tolerance, Received& out) const {
        out.reset(floor.size(), radiosity.columns.stride);
        return cast_emission(radiosity, lamps, floor, everyone, tolerance, {}, out);
    }
};

float mean(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
}

TEST(Lamps, BranchesCoverAllLampsGroupByGroup) {
    const Stage stage(36);
    ASSERT_EQ(stage.lamps.size(), 144u);
    ASSERT_EQ(stage.lamps.roots().size(), 4u);
    std::uint32_t next = 0;
    for (const std::uint32_t root : stage.lamps.roots()) {
        const auto branch = stage.lamps.branches()[root];
        EXPECT_EQ(branch.begin, next);
        next = branch.end;
        const auto first = stage.lamps.all()[branch.begin].emitted;
        const auto lit = std::ranges::find_if(first, [](float e) { return e > 0; });
        for (std::uint32_t l = branch.begin; l < branch.end; ++l)
            EXPECT_GT(stage.lamps.all()[l].emitted[static_cast<std::size_t>(lit - first.begin())],
                      0);
    }
    EXPECT_EQ(next, 144u);
    for (std::size_t b = 0; b < stage.lamps.branches().size(); ++b) {
        const auto branch = stage.lamps.branches()[b];
        if (branch.right == 0) {
            EXPECT_EQ(branch.end, branch.begin + 1);
            continue;
        }
        const auto left = stage.lamps.branches()[b + 1],
                   right = stage.lamps.branches()[branch.right];
        EXPECT_EQ(left.begin, branch.begin);
        EXPECT_EQ(left.end, right.begin);
        EXPECT_EQ(right.end, branch.end);
    }
}

// The tolerance is what irradiance may be off by in the mean square, shared views included; two
// thirds of the rays at least are saved.
TEST(Lamps, FaintOnesShareTheirViewsWithinTheTolerance) {
    const Stage stage(144);
    Received truth, shared;
    const std::uint64_t all_rays = stage.cast(1e-4f, truth);
    const float tolerance = 0.05f * mean(truth.light);
    const std::uint64_t rays = stage.cast(tolerance, shared);
    EXPECT_LT(3 * rays, all_rays);
    double square = 0, bias = 0, variance = 0;
    for (std::size_t i = 0; i < stage.floor.size(); ++i) {
        EXPECT_NEAR(shared.unblocked[i], truth.unblocked[i], 1e-4f * truth.unblocked[i]);
        const double off = double(shared.light[i]) - double(truth.light[i]);
        square += off * off, bias += off, variance += double(shared.variance[i]);
    }
    const auto count = static_cast<double>(stage.floor.size());
    EXPECT_LT(std::sqrt(square / count), double(tolerance));
    EXPECT_LT(std::abs(bias / count), 0.1 * double(tolerance));
    // What it says of its noise is of the right size.
    EXPECT_GT(variance, square / 9);
    EXPECT_LT(variance, square * 9);
}

TEST(Lamps, GroupsKeepTheirOwnShadows) {
    const Stage stage(1);
    Received truth, coarse;
    stage.cast(1e-4f, truth);
    const float tolerance = 0.05f * mean(truth.light);
    stage.cast(tolerance, coarse);
    // The one ray of a faint lamp may be wrong in its penumbra, which is narrow, and nowhere else.
    const Columns& columns = stage.radiosity.columns;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < stage.floor.size(); ++i)
        for (std::size_t g = 0; g < columns.groups; ++g) {
            const float is = truth.row(i, columns.stride)[g * columns.bands],
                        found = coarse.row(i, columns.stride)[g * columns.bands];
            wrong += std::abs(found - is) > 0.5f * std::max(found, is);
        }
    EXPECT_LT(wrong, stage.floor.size() * columns.groups / 200);
}

}  // namespace
}  // namespace exitance
