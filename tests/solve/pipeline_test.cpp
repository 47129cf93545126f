// SPDX-License-Identifier: Apache-2.0
// Whole solves: what must not matter does not, what must matter does, and whatever stops them
// leaves a valid solution.
#include "exitance/pipeline.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "exitance/run/error.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_square;
using exitance::testing::add_surface;

// Most of these are about shooting; gathering_test.cpp is about the default.
SolveOptions quick() {
    SolveOptions options;
    options.solver = "shooting";
    options.error = 0.05;
    return options;
}

std::string bytes_of(const Solution& solution) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("exitance_pipeline_" + std::to_string(::getpid()) + ".glb");
    write_solution(solution, path);
    std::ifstream in(path, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    std::filesystem::remove(path);
    return out.str();
}

TEST(Pipeline, OneAndTwoThreadsGiveTheSameBytes) {
    SolveOptions options = quick();
    options.threads = 1;
    const std::string one = bytes_of(light(two_lamp_room(), options));
    options.threads = 2;
    EXPECT_TRUE(bytes_of(light(two_lamp_room(), options)) == one);
}

TEST(Pipeline, TheSeedDecidesTheBytes) {
    SolveOptions options = quick();
    const std::string base = bytes_of(light(two_lamp_room(), options));
    EXPECT_TRUE(bytes_of(light(two_lamp_room(), options)) == base);
    options.seed = 1;
    EXPECT_FALSE(bytes_of(light(two_lamp_room(), options)) == base);
}

// The room with only one of its lamps lit.
Scene with_only(Scene scene, const std::string& lamp) {
    for (Material& material : scene.materials)
        if (material.name != lamp) material.exitance.assign(3, 0.0);
    return scene;
}

SolveOptions converged() {
    SolveOptions options = quick();
    options.adaptive = false;
    options.merge = false;
    options.unshot = 1e-5;
    return options;
}

TEST(Pipeline, AnUnreachableTargetEndsAtTheRoundingOfFloat) {
    SolveOptions options = converged();
    options.time = 30;  // so that a failure ends
    options.unshot = 0;
    double left = 1;
    for (const bool overshoot : {true, false})
        for (const bool adaptive : {true, false}) {
            options.overshoot = overshoot, options.adaptive = adaptive;
            const Stopwatch clock;
            light(two_lamp_room(false), options,
                  {[&](const Progress& progress) { left = progress.fraction_left; }});
            EXPECT_LT(clock.seconds(), 20) << overshoot << adaptive;
            EXPECT_LT(left, 1e-5) << overshoot << adaptive;
        }
}

TEST(Pipeline, GroupsSolvedTogetherAreTheirOwnSolutions) {
    // Without shadows there is no sampling, only how far each solve converged.
    const Scene scene = two_lamp_room(false);
    SolveOptions options = converged();
    options.occlusion = false;
    options.unshot = 3e-6;  // what either solve leaves differs by as much
    for (const bool overshoot : {false, true}) {
        options.overshoot = overshoot;
        const Solution both = light(scene, options);
        ASSERT_EQ(both.groups.size(), 2u);
        for (std::size_t g = 0; g < 2; ++g) {
            const Solution alone = light(with_only(scene, both.groups[g].name), options);
            ASSERT_EQ(alone.positions.size(), both.positions.size());
            for (std::size_t band = 0; band < 3; ++band) {
                const Comparison found = compare(both, alone, 3 * g + band, band);
                EXPECT_LT(found.rms, 1e-5) << overshoot << g << band;
                EXPECT_LT(found.worst, 1e-4) << overshoot << g << band;
            }
        }
    }
}

TEST(Pipeline, GroupsInShadowAgreeWithinSampling) {
    // Their rays are other ones: each solve decides by its own light how many it needs.
    const Scene scene = two_lamp_room();
    const Solution both = light(scene, converged());
    for (std::size_t g = 0; g < 2; ++g) {
        const Solution alone = light(with_only(scene, both.groups[g].name), converged());
        for (std::size_t band = 0; band < 3; ++band) {
            const Comparison c = compare(both, alone, 3 * g + band, band);
            EXPECT_LT(c.rms, 0.02) << both.groups[g].name << " band " << band;
            EXPECT_LT(std::abs(c.bias), 0.005) << both.groups[g].name << " band " << band;
        }
    }
}

TEST(Pipeline, OneGroupIsTheSumOfTwo) {
    SolveOptions options = converged();
    const Solution two = light(two_lamp_room(), options);
    options.groups = "none";
    const Solution one = light(two_lamp_room(), options);
    ASSERT_EQ(one.columns(), 3u);
    double worst = 0;
    for (std::size_t v = 0; v < one.positions.size(); ++v)
        for (std::size_t band = 0; band < 3; ++band) {
            const auto row = two.irradiance[VertexId(v)];
            const float sum = row[band] + row[3 + band];
            worst = std::max(worst, double(std::abs(sum - one.irradiance[VertexId(v)][band])));
        }
    // The same rays and the same shots: only rounding differs.
    EXPECT_LT(worst, 1e-3 * mean_irradiance(one, 1, 0));
}

TEST(Pipeline, OvershootingChangesTheWayNotTheGoal) {
    SolveOptions options = converged();
    for (const bool occlusion : {false, true}) {
        options.occlusion = occlusion;
        options.overshoot = true;
        const Solution with = light(two_lamp_room(), options);
        options.overshoot = false;
        const Solution without = light(two_lamp_room(), options);
        // With shadows the shots, and with them the rays, are other ones.
        for (std::size_t c = 0; c < with.columns(); ++c) {
            const Comparison found = compare(with, without, c, c);
            EXPECT_LT(found.rms, occlusion ? 5e-3 : 1e-4) << c;
            EXPECT_LT(std::abs(found.bias), occlusion ? 2e-3 : 1e-4) << c;
        }
    }
}

TEST(Pipeline, DiskFactorsAgreeWithinTheirAccuracy) {
    SolveOptions options = converged();
    options.unshot = 1e-3;
    const Solution exact = light(two_lamp_room(), options);
    options.form_factor = "disk";
    const Solution disk = light(two_lamp_room(), options);
    for (std::size_t c = 0; c < exact.columns(); ++c) {
        // One disc often stands for a patch half a metre wide, and sends too little to what is
        // near.
        const Comparison found = compare(exact, disk, c, c);
        EXPECT_LT(found.rms, 0.3) << c;
        EXPECT_LT(found.bias, 0) << c;
        EXPECT_GT(found.bias, -0.25) << c;
    }
}

TEST(Pipeline, WithoutOcclusionThereAreNoShadows) {
    SolveOptions options = converged();
    options.unshot = 1e-3;
    const Solution shaded = light(two_lamp_room(), options);
    options.occlusion = false;
    const Solution open = light(two_lamp_room(), options);
    EXPECT_GT(compare(shaded, open, 0, 0).rms, 0.02);
    EXPECT_GT(compare(shaded, open, 0, 0).bias, 0);
}

TEST(Pipeline, AdaptivityPutsVerticesWhereShadowsAre) {
    SolveOptions options = quick();
    const Solution fine = light(two_lamp_room(), options);
    options.adaptive = false;
    const Solution coarse = light(two_lamp_room(), options);
    EXPECT_GT(fine.positions.size(), 2 * coarse.positions.size());
}

TEST(Pipeline, MergingSavesVerticesAndHardlyChangesTheLight) {
    SolveOptions options = quick();
    const Solution merged = light(two_lamp_room(), options);
    options.merge = false;
    const Solution whole = light(two_lamp_room(), options);
    EXPECT_LT(merged.positions.size(), whole.positions.size());
    for (std::size_t part = 0; part < whole.parts.size(); ++part)
        for (std::size_t c = 0; c < whole.columns(); ++c)
            EXPECT_NEAR(mean_irradiance(merged, c, part), mean_irradiance(whole, c, part),
                        0.01 * mean_irradiance(whole, c, 0));
}

TEST(Pipeline, LightIsNotLost) {
    for (const bool block : {false, true}) {
        const Solution solution = light(two_lamp_room(block), quick());
        EXPECT_LT(std::abs(solution.energy.imbalance()), 0.01) << block;
        EXPECT_LT(solution.energy.escaped, 1e-3 * solution.energy.emitted);
        EXPECT_GT(solution.energy.unshot, -0.05 * solution.energy.emitted);
        EXPECT_LT(solution.energy.unshot, 0.05 * solution.energy.emitted);
    }
}

TEST(Pipeline, TimeStopsAndKeepsAValidSolution) {
    SolveOptions options;
    options.error = 0.002;  // far more work than the time allows
    options.time = 0.3;
    const Stopwatch clock;
    const Solution solution = light(two_lamp_room(), options);
    EXPECT_LT(clock.seconds(), 60) << "a step in progress, balance and extraction are allowed";
    EXPECT_TRUE(all_finite(solution));
    EXPECT_GT(mean_irradiance(solution, 0, 0), 0);
    EXPECT_FALSE(bytes_of(solution).empty());
}

TEST(Pipeline, CancelKeepsAValidSolution) {
    for (const int steps : {0, 1, 5}) {
        Cancel cancel;
        int seen = 0;
        if (steps == 0) cancel.request();
        const Solution solution = light(
            two_lamp_room(), quick(),
            [&](const Progress& progress) {
                EXPECT_GE(progress.seconds, 0);
                EXPECT_TRUE(std::isfinite(progress.fraction_left));
                if (++seen == steps) cancel.request();
            },
            &cancel);
        EXPECT_LE(seen, steps);
        EXPECT_TRUE(all_finite(solution));
        EXPECT_EQ(solution.parts.size(), two_lamp_room().surfaces.size());
        if (steps > 1) {
            EXPECT_GT(mean_irradiance(solution, 0, 0), 0);
        }
        EXPECT_FALSE(bytes_of(solution).empty());
    }
}

TEST(Pipeline, ProgressFallsToItsTarget) {
    double last_seconds = 0, left = 1;
    std::uint64_t shots = 0;
    std::optional<double> target;
    light(two_lamp_room(), quick(), [&](const Progress& progress) {
        EXPECT_GE(progress.seconds, last_seconds);
        EXPECT_GE(progress.shots, shots);
        last_seconds = progress.seconds, shots = progress.shots;
        left = progress.fraction_left, target = progress.fraction_target;
    });
    ASSERT_TRUE(target);
    EXPECT_LE(left, *target * 1.001);
    EXPECT_GT(shots, 10u);
}

TEST(Pipeline, SnapshotsComeAsAskedAndEndWithTheWhole) {
    std::vector<double> means;
    Snapshots snapshots;
    snapshots.every = 20;
    snapshots.take = [&](Solution so_far) {
        EXPECT_TRUE(all_finite(so_far));
        means.push_back(mean_irradiance(so_far, 1, 0));
    };
    SolveOptions options = quick();
    options.overshoot = false;
    light(two_lamp_room(), options, {}, nullptr, snapshots);
    ASSERT_GT(means.size(), 3u);
    EXPECT_GT(means.back(), 1.2 * means.front()) << "light grows from shot to shot";
}

TEST(Pipeline, SolversOfElementsShowWhatTheyHaveMeanwhile) {
    SolveOptions options = quick();
    options.solver = "jacobi";
    const Solution alone = light(two_lamp_room(), options);
    std::vector<double> means;
    Snapshots snapshots;
    snapshots.wanted = [](const Progress&) { return true; };
    snapshots.take = [&](Solution so_far) {
        EXPECT_TRUE(all_finite(so_far));
        means.push_back(mean_irradiance(so_far, 1, 0));
    };
    const Solution watched = light(two_lamp_room(), options, {}, nullptr, snapshots);
    ASSERT_GT(means.size(), 4u) << "nothing yet, direct light, sweeps, the end";
    // Jacobi's sweeps only ever add light; the last state is gathered anew: other rays.
    for (std::size_t i = 1; i + 1 < means.size(); ++i) EXPECT_GE(means[i], means[i - 1]);
    EXPECT_NEAR(means[means.size() - 2], means.back(), 0.05 * means.back());
    EXPECT_TRUE(std::equal(alone.irradiance.values().begin(), alone.irradiance.values().end(),
                           watched.irradiance.values().begin()))
        << "watching changes nothing";
}

TEST(Pipeline, SnapshotsSayWhatIsUnshot) {
    // Over the surfaces it adds up to what the solver says is left.
    std::vector<std::pair<double, double>> flux_and_left;
    double left = 1;
    Snapshots snapshots;
    snapshots.every = 10;
    snapshots.unshot = true;
    snapshots.take = [&](const Solution& so_far) {
        ASSERT_EQ(so_far.unshot.size(), so_far.positions.size());
        double flux = 0;
        for (const auto& t : so_far.triangles) {
            const Vec3f &a = so_far.positions[t[0]], &b = so_far.positions[t[1]],
                        &c = so_far.positions[t[2]];
            const double area = double(length(cross(b - a, c - a))) / 2;
            for (const std::uint32_t v : t) {
                EXPECT_GE(so_far.unshot[v], 0.0f);
                flux += area / 3 * double(so_far.unshot[v]);
            }
        }
        flux_and_left.push_back({flux, left});
    };
    SolveOptions options = quick();
    options.overshoot = false;  // what was shot too much would count against it
    const Observer watch = [&](const Progress& progress) { left = progress.fraction_left; };
    const Solution solution = light(two_lamp_room(), options, watch, nullptr, snapshots);
    EXPECT_TRUE(solution.unshot.empty());
    ASSERT_GT(flux_and_left.size(), 5u);
    EXPECT_LT(flux_and_left.back().second, 0.3 * flux_and_left.front().second);
    // Vertices share what is unshot with all leaves around them, a patch that has just shot with
    // its neighbours, which moves light but loses none: exact but for leaves of unequal size.
    for (const auto& [flux, share] : flux_and_left)
        EXPECT_NEAR(flux, share * solution.energy.emitted, 0.1 * share * solution.energy.emitted);
}

TEST(Pipeline, UnlitSceneIsDark) {
    Scene scene;
    add_room(scene, {}, {1, 1, 1}, 0.7);
    const Solution solution = light(scene, quick());
    for (const float x : solution.irradiance.values()) EXPECT_EQ(x, 0.0f);
    EXPECT_EQ(solution.energy.emitted, 0);
    EXPECT_EQ(solution.energy.imbalance(), 0);
    EXPECT_FALSE(bytes_of(solution).empty());
}

TEST(Pipeline, SceneWithoutReflection) {
    Scene scene;
    add_room(scene, {}, {2, 2, 2}, 0);
    add_lamp(scene, "lamp", {1, 1, 1.9}, 0.5, {10, 10, 10});
    const Solution solution = light(scene, quick());
    EXPECT_TRUE(all_finite(solution));
    // All that the lamp emits is absorbed: 10 · 0.25 on the room's inside, but for what the top of
    // the lamp hides and interpolation misses.
    EXPECT_NEAR(solution.energy.absorbed / solution.energy.emitted, 1, 0.01);
    EXPECT_NEAR(solution.energy.unshot, 0, 1e-6 * solution.energy.emitted);
}

TEST(Pipeline, ASingleTriangle) {
    Scene scene;
    add_polygon(scene, add_surface(scene, "t", 0.5, 3), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const Solution solution = light(scene, quick());
    EXPECT_TRUE(all_finite(solution));
    for (const float x : solution.irradiance.values()) EXPECT_EQ(x, 0.0f) << "it lights nothing";
    EXPECT_NEAR(solution.energy.escaped, solution.energy.emitted, 1e-6);
    EXPECT_NEAR(solution.energy.emitted, 1.5, 1e-6);
}

TEST(Pipeline, BrightAndDarkScenesAreTheSameButForScale) {
    // A solve may not know in which unit its light is.
    for (const char* solver : {"shooting", "gathering"}) {
        SolveOptions options = quick();
        options.solver = solver;
        Scene faint = two_lamp_room(), bright = two_lamp_room();
        for (Material& m : faint.materials)
            for (double& e : m.exitance) e *= 0x1.0p-20;
        for (Material& m : bright.materials)
            for (double& e : m.exitance) e *= 0x1.0p20;
        const Solution a = light(faint, options), b = light(bright, options);
        ASSERT_EQ(a.positions.size(), b.positions.size()) << solver;
        for (std::size_t v = 0; v < a.positions.size(); ++v)
            for (std::size_t c = 0; c < a.columns(); ++c)
                EXPECT_EQ(a.irradiance[VertexId(v)][c] * 0x1.0p40f, b.irradiance[VertexId(v)][c]);
    }
}

TEST(Pipeline, LargeAndSmallScenesAreTheSameButForScale) {
    Scene small = two_lamp_room(), large = two_lamp_room();
    for (Vec3& p : small.points) p *= 0x1.0p-10;
    for (Vec3& p : large.points) p *= 0x1.0p10;
    const Solution a = light(small, quick()), b = light(large, quick());
    ASSERT_NEAR(double(a.positions.size()), double(b.positions.size()),
                0.02 * double(b.positions.size()));
    for (std::size_t part = 0; part < a.parts.size(); ++part)
        for (std::size_t c = 0; c < a.columns(); ++c)
            EXPECT_NEAR(mean_irradiance(a, c, part), mean_irradiance(b, c, part),
                        0.01 * mean_irradiance(b, c, 0));
}

TEST(Pipeline, StopsWhereTheOptionsSay) {
    SolveOptions options = quick();
    options.unshot = 0.3;
    const Solution early = light(two_lamp_room(), options);
    options.unshot = 0.01;
    const Solution late = light(two_lamp_room(), options);
    EXPECT_LT(early.counters.at("shots"), late.counters.at("shots"));
    EXPECT_LT(std::abs(late.energy.unshot), 0.02 * late.energy.emitted);
    options = quick();
    options.next_shot = 1;
    EXPECT_LE(light(two_lamp_room(), options).counters.at("shots"), 3)
        << "the emission alone: no patch reflects all of the light";
}

TEST(TwoPlates, HaveTheMeansThatTheSceneFileStates) {
    const Scene scene =
        read_scene(std::filesystem::path(EXITANCE_SOURCE_DIR) / "scenes/two_plates.toml");
    SolveOptions options;
    options.error = 0.01;
    const Solution solution = light(scene, options);
    ASSERT_EQ(solution.parts.size(), 2u);
    ASSERT_EQ(solution.parts[0].name, "ceiling");
    // B = E + ρ H, means over the plates; half a percent for interpolation (light is concave).
    EXPECT_NEAR(12 + 0.75 * mean_irradiance(solution, 0, 0), 12.5385, 0.005 * 12.5385);
    EXPECT_NEAR(0.5 * mean_irradiance(solution, 0, 1), 2.0926, 0.005 * 2.0926);
}

}  // namespace
}  // namespace exitance
