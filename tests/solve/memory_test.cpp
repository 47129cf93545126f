// SPDX-License-Identifier: Apache-2.0
// --memory: what fits is not changed, what does not fit is left coarse and says so, and what could
// not be solved at all is refused.
#include "exitance/solve/memory.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/pipeline.h"
#include "exitance/run/error.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;

constexpr double plenty = 1e5;  // MB

SolveOptions options_of(double error, std::optional<double> memory) {
    SolveOptions options;
    options.error = error;
    options.memory = memory;
    return options;
}

TEST(Memory, PlentyChangesNothing) {
    const Scene scene = two_lamp_room();
    const Solution without = light(scene, options_of(0.02, {}));
    const Solution with = light(scene, options_of(0.02, plenty));
    EXPECT_EQ(with.triangles, without.triangles);
    EXPECT_TRUE(std::ranges::equal(with.irradiance.values(), without.irradiance.values()));
    EXPECT_EQ(with.options, without.options);
    EXPECT_EQ(with.counters, without.counters);
}

TEST(Memory, LittleEndsTheMeshAndSaysSo) {
    const Scene scene = two_lamp_room();
    const Solution without = light(scene, options_of(0.005, {}));
    ASSERT_FALSE(without.counters.contains("vertices_by_memory"));
    std::size_t last = 0;
    double last_error = INFINITY;
    for (const double memory : {42.0, 50.0}) {
        const Solution with = light(scene, options_of(0.005, memory));
        EXPECT_TRUE(all_finite(with));
        EXPECT_LT(with.positions.size(), without.positions.size()) << memory;
        EXPECT_GT(with.positions.size(), last) << memory;
        ASSERT_TRUE(with.error);
        EXPECT_LT(with.error->rms, last_error) << memory;
        EXPECT_TRUE(with.counters.contains("vertices_by_memory"));
        EXPECT_EQ(with.options.at("memory"), std::to_string(static_cast<int>(memory)));
        EXPECT_LT(std::abs(with.energy.imbalance()), 0.02);
        last = with.positions.size(), last_error = with.error->rms;
    }
}

TEST(Memory, ThePlanKeepsTheMeshWithinIt) {
    const Scene scene = two_lamp_room();
    const Radiosity radiosity(scene, make_groups(scene, Grouping::file),
                              MeshOptions::of_patches(0.25));
    const MemoryPlan little(radiosity, 45e6, 0), more(radiosity, 90e6, 0),
        besides(radiosity, 90e6, 40e6);
    EXPECT_GE(little.most_vertices(), radiosity.mesh.vertices().size());
    EXPECT_GT(more.most_vertices(), 2 * little.most_vertices());
    EXPECT_LT(besides.most_vertices(), more.most_vertices());
    EXPECT_LE(little.most_vertices_of_direct(), little.most_vertices());
    const Solution solution = light(scene, [] {
        SolveOptions options = options_of(0.002, 45);
        options.patch_size = 0.25;
        return options;
    }());
    // A division more may take its neighbours along.
    EXPECT_LE(solution.counters.at("vertices"), 1.01 * double(little.most_vertices()));
}

TEST(Memory, RaysOfPatchesAreAsManyAsTheirHitsHaveRoom) {
    const Scene scene = two_lamp_room();
    const Radiosity radiosity(scene, make_groups(scene, Grouping::file),
                              MeshOptions::of_patches(0.02));
    const std::size_t vertices = radiosity.mesh.vertices().size();
    const MemoryPlan little(radiosity, 250e6, 0), much(radiosity, 4e9, 0);
    EXPECT_EQ(much.patch_rays(1024, vertices), 1024u);
    const std::uint32_t rays = little.patch_rays(1024, vertices);
    EXPECT_GE(rays, 16u);
    EXPECT_LT(rays, 1024u);
    EXPECT_EQ(rays & (rays - 1), 0u);
}

TEST(Memory, WhatCannotFitIsRefused) {
    const auto message = [](const Scene& scene, const SolveOptions& options) -> std::string {
        try {
            light(scene, options);
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::could_not_finish);
            return error.what();
        }
        return "nothing";
    };
    SolveOptions options = options_of(0.02, 20);
    EXPECT_NE(message(two_lamp_room(), options).find("--memory 20 MB: this scene needs at least"),
              std::string::npos);
    options.memory = 500, options.patch_size = 0.0005;  // 10⁸ of them, not to be made
    EXPECT_NE(message(two_lamp_room(), options).find("this scene needs at least"),
              std::string::npos);
}

TEST(Memory, OtherSolversRefuseIt) {
    for (const char* solver : {"shooting", "jacobi"}) {
        SolveOptions options = options_of(0.1, plenty);
        options.solver = solver;
        EXPECT_THROW(light(two_lamp_room(), options), Error) << solver;
    }
}

TEST(Memory, CountsWhatIsResumed) {
    const Scene scene = two_lamp_room();
    Resumption resumption{light(scene, options_of(0.02, {}))};
    const std::size_t before = resumption.from.positions.size();
    const double error = resumption.from.error->rms;
    const Solution after = light(scene, options_of(0.002, 60), {}, nullptr, {}, &resumption);
    EXPECT_LE(after.error->rms, error);
    if (resumption.outcome == Resumption::Outcome::kept) {
        EXPECT_EQ(after.positions.size(), before);
    }
}

}  // namespace
}  // namespace exitance
