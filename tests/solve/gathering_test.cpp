// SPDX-License-Identifier: Apache-2.0
// The gathering solver: what must not matter does not, and whatever stops it leaves light
// everywhere.
#include "exitance/solve/gathering.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/pipeline.h"
#include "exitance/run/error.h"
#include "exitance/solve/element_methods.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;

SolveOptions gathering(double error = 0.05) {
    SolveOptions options;
    options.solver = adaptive_gathering;
    options.error = error;
    return options;
}

void expect_same(const Solution& a, const Solution& b) {
    ASSERT_EQ(a.positions.size(), b.positions.size());
    ASSERT_EQ(a.triangles, b.triangles);
    for (std::size_t i = 0; i < a.irradiance.values().size(); ++i)
        ASSERT_EQ(a.irradiance.values()[i], b.irradiance.values()[i]) << i;
}

TEST(Gathering, OneAndTwoThreadsGiveTheSame) {
    SolveOptions options = gathering();
    options.threads = 1;
    const Solution one = light(two_lamp_room(), options);
    options.threads = 2;
    expect_same(one, light(two_lamp_room(), options));
}

TEST(Gathering, TheSeedDecides) {
    SolveOptions options = gathering();
    const Solution base = light(two_lamp_room(), options);
    expect_same(base, light(two_lamp_room(), options));
    options.seed = 1;
    const Solution other = light(two_lamp_room(), options);
    EXPECT_TRUE(base.positions.size() != other.positions.size() ||
                !std::ranges::equal(base.irradiance.values(), other.irradiance.values()));
}

Scene with_only(Scene scene, const std::string& lamp) {
    for (Material& material : scene.materials)
        if (material.name != lamp) material.exitance.assign(3, 0.0);
    return scene;
}

TEST(Gathering, GroupsTogetherAreEachAlone) {
    // On the same vertices; each solve decides by its own light how many rays it needs.
    const auto even = [] {
        SolveOptions options = gathering(0.01);
        options.adaptive = false, options.merge = false;
        return options;
    }();
    const Scene scene = two_lamp_room();
    const Solution both = light(scene, even);
    ASSERT_EQ(both.groups.size(), 2u);
    for (std::size_t g = 0; g < 2; ++g) {
        const Solution alone = light(with_only(scene, both.groups[g].name), even);
        for (std::size_t band = 0; band < 3; ++band) {
            const Comparison found = compare(both, alone, 3 * g + band, band);
            EXPECT_LT(found.rms, 0.02) << g << band;
            EXPECT_LT(std::abs(found.bias), 0.005) << g << band;
        }
    }
}

TEST(Gathering, OneGroupIsTheSumOfTwo) {
    SolveOptions options = gathering();
    options.merge = false;  // looks at groups one by one
    const Solution two = light(two_lamp_room(), options);
    options.groups = "none";
    const Solution one = light(two_lamp_room(), options);
    ASSERT_EQ(one.columns(), 3u);
    ASSERT_EQ(one.positions.size(), two.positions.size());
    double worst = 0;
    for (std::size_t v = 0; v < one.positions.size(); ++v)
        for (std::size_t band = 0; band < 3; ++band) {
            const auto row = two.irradiance[VertexId(v)];
            const float sum = row[band] + row[3 + band];
            worst = std::max(worst, double(std::abs(sum - one.irradiance[VertexId(v)][band])));
        }
    EXPECT_LT(worst, 1e-3 * mean_irradiance(one, 1, 0)) << "the same rays: only rounding differs";
}

TEST(Gathering, AgreesWithShooting) {
    SolveOptions options = gathering(0.01);
    const Solution gathered = light(two_lamp_room(), options);
    options.solver = adaptive_shooting;
    const Solution shot = light(two_lamp_room(), options);
    for (std::size_t part = 0; part < shot.parts.size(); ++part) {
        if (shot.materials[shot.parts[part].material].emits()) continue;  // and reflect nothing
        for (std::size_t c = 0; c < shot.columns(); ++c)
            EXPECT_NEAR(mean_irradiance(gathered, c, part), mean_irradiance(shot, c, part),
                        0.01 * mean_irradiance(shot, c, 0))
                << part << " " << c;
    }
}

TEST(Gathering, LightIsNotLost) {
    for (const bool block : {false, true}) {
        const Solution solution = light(two_lamp_room(block), gathering(0.02));
        EXPECT_LT(std::abs(solution.energy.imbalance()), 0.01) << block;
        EXPECT_LT(std::abs(solution.energy.unshot), 0.01 * solution.energy.emitted) << block;
    }
}

TEST(Gathering, UnlitAndBlackScenes) {
    Scene dark;
    add_room(dark, {}, {1, 1, 1}, 0.7);
    const Solution nothing = light(dark, gathering());
    for (const float x : nothing.irradiance.values()) EXPECT_EQ(x, 0.0f);
    Scene black;
    add_room(black, {}, {2, 2, 2}, 0);
    add_lamp(black, "lamp", {1, 1, 1.9}, 0.5, {10, 10, 10});
    const Solution direct = light(black, gathering(0.02));
    EXPECT_TRUE(all_finite(direct));
    EXPECT_NEAR(direct.energy.absorbed / direct.energy.emitted, 1, 0.01);
}

TEST(Gathering, RefusesWhatItHasNoUseFor) {
    const auto refused = [](const auto& set) {
        SolveOptions options = gathering();
        set(options);
        EXPECT_THROW(light(two_lamp_room(), options), Error);
    };
    refused([](SolveOptions& o) { o.unshot = 0.1; });
    refused([](SolveOptions& o) { o.next_shot = 0.1; });
    refused([](SolveOptions& o) { o.overshoot = false; });
    refused([](SolveOptions& o) { o.occlusion = false; });
    refused([](SolveOptions& o) { o.form_factor = "disk"; });
    refused([](SolveOptions& o) { o.factors = "pairs"; });
    refused([](SolveOptions& o) { o.transport = "dense"; });
}

// Every vertex of a room whose walls all see lit walls has light, whenever it is stopped.
TEST(Gathering, WhereverItIsStoppedItsLightIsComplete) {
    const Scene scene = two_lamp_room(false);
    const Solution whole = light(scene, gathering(0.02));
    int steps = 0;
    light(scene, gathering(0.02), [&](const Progress&) { ++steps; });
    ASSERT_GT(steps, 4);
    for (int stop = 2; stop < steps; ++stop) {  // from the balance on
        Cancel cancel;
        int seen = 0;
        const Solution solution = light(
            scene, gathering(0.02),
            [&](const Progress& progress) {
                EXPECT_TRUE(std::isfinite(progress.fraction_left));
                if (++seen == stop) cancel.request();
            },
            &cancel);
        EXPECT_TRUE(all_finite(solution));
        ASSERT_EQ(solution.parts[0].name, "room");
        for (std::size_t c = 0; c < solution.columns(); ++c)
            EXPECT_NEAR(mean_irradiance(solution, c, 0), mean_irradiance(whole, c, 0),
                        0.05 * mean_irradiance(whole, c, 0))
                << "stopped after " << stop << " of " << steps;
    }
}

TEST(Gathering, CancelledBeforeItBegins) {
    Cancel cancel;
    cancel.request();
    EXPECT_TRUE(all_finite(light(two_lamp_room(), gathering(), {}, &cancel)));
}

TEST(Gathering, InterruptedOnTheWayToLessErrorItKeepsTheBest) {
    SolveOptions options = gathering(0.01);
    options.min_area = 0.05;  // takes more than one demand
    Cancel cancel;
    std::optional<double> known;
    int after = 0;
    const Solution solution = light(
        two_lamp_room(), options,
        [&](const Progress& progress) {
            if (!progress.error) return;
            known = progress.error;
            if (++after == 2) cancel.request();  // new direct light, and the balance of it
        },
        &cancel);
    ASSERT_TRUE(known) << "the first demand was enough";
    ASSERT_TRUE(solution.error);
    EXPECT_LE(solution.error->rms, *known);
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.01);
}

TEST(Gathering, ProgressFalls) {
    double left = 1;
    light(two_lamp_room(), gathering(0.004), [&](const Progress& progress) {
        EXPECT_LE(progress.fraction_left, left);
        left = progress.fraction_left;
    });
    EXPECT_LT(left, 0.5);
}

TEST(Gathering, TimeStopsIt) {
    SolveOptions options = gathering(0.001);  // far more work than the time allows
    options.time = 2;
    const Stopwatch clock;
    const Solution solution = light(two_lamp_room(), options);
    EXPECT_LT(clock.seconds(), 60) << "a step in progress, balance and extraction are allowed";
    EXPECT_TRUE(all_finite(solution));
    EXPECT_GT(mean_irradiance(solution, 0, 0), 0);
}

bool same_light(const Solution& a, const Solution& b) {
    return std::ranges::equal(a.irradiance.values(), b.irradiance.values());
}

TEST(Gathering, WithoutAnyTimeThereIsCompleteLight) {
    SolveOptions options = gathering(0.01);
    options.time = 0;
    const Solution sketch = light(two_lamp_room(), options);
    ASSERT_TRUE(sketch.error);
    EXPECT_LT(sketch.error->rms, 0.5) << "rough, but each patch has what reaches it";
    // Direct light between the corners of patches a fifth of the room wide is what it errs by.
    EXPECT_LT(std::abs(sketch.energy.imbalance()), 0.1);
    options.time.reset();
    Cancel cancel;
    cancel.request();
    EXPECT_TRUE(same_light(light(two_lamp_room(), options, {}, &cancel), sketch))
        << "nor when it is interrupted at once";
}

TEST(Gathering, BeginningWithASketchEndsWithTheSame) {
    SolveOptions options = gathering(0.05);
    const Solution plain = light(two_lamp_room(), options);
    options.time = 1e6;
    const Solution sketched = light(two_lamp_room(), options);
    EXPECT_TRUE(same_light(plain, sketched));
}

TEST(Gathering, LessErrorTakesMoreVerticesAndIsFound) {
    const Solution rough = light(two_lamp_room(), gathering(0.1));
    const Solution fine = light(two_lamp_room(), gathering(0.01));
    EXPECT_GT(fine.positions.size(), rough.positions.size());
    ASSERT_TRUE(fine.error);
    EXPECT_LT(fine.error->rms, 0.012);
}

}  // namespace
}  // namespace exitance
