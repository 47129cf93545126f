// SPDX-License-Identifier: Apache-2.0
// A solve that goes on from a solution begins with its mesh, is never worse, and does no more than
// is asked for.
#include "exitance/solution/resume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "exitance/pipeline.h"
#include "exitance/run/error.h"
#include "exitance/solution/extract.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;
using Outcome = Resumption::Outcome;

SolveOptions to_error(double error) {
    SolveOptions options;
    options.error = error;
    return options;
}

Solution resumed(const Scene& scene, const SolveOptions& options, Resumption& from,
                 const Cancel* cancel = nullptr, const Observer& observe = {}) {
    return light(scene, options, observe, cancel, {}, &from);
}

void expect_same(const Solution& a, const Solution& b) {
    ASSERT_EQ(a.triangles, b.triangles);
    EXPECT_TRUE(std::ranges::equal(a.irradiance.values(), b.irradiance.values()));
}

/// A quad that is no rectangle, a triangle and a two-sided board besides walls, lamps and a block.
Scene varied_room() {
    Scene scene = two_lamp_room();
    const auto s = testing::add_surface(scene, "board", 0.5);
    scene.materials[scene.surfaces[s].material].two_sided = true;
    testing::add_polygon(scene, s,
                         {{0.2, 1.2, 0.4}, {0.9, 1.3, 0.4}, {0.7, 1.8, 0.4}, {0.3, 1.6, 0.4}});
    testing::add_polygon(scene, s, {{2.1, 1.2, 0.6}, {2.8, 1.2, 0.6}, {2.4, 1.8, 0.9}});
    return scene;
}

std::vector<std::array<float, 3>> sorted_places(const Solution& solution) {
    std::vector<std::array<float, 3>> out;
    for (const Vec3f& p : solution.positions) out.push_back({p.x, p.y, p.z});
    std::sort(out.begin(), out.end());
    return out;
}

TEST(Resume, TakesTheSameMeshOver) {
    const Scene scene = varied_room();
    SolveOptions options = to_error(0.03);
    options.patch_size = 0.5;
    for (const bool merge : {false, true}) {
        options.merge = merge;
        const Solution before = light(scene, options);
        Radiosity radiosity(scene, make_groups(scene, Grouping::file),
                            MeshOptions::of_patches(0.5));
        const std::size_t patches = radiosity.mesh.elements().size();
        const std::vector<PatchId> patch_of = take_over_mesh(radiosity, before);
        EXPECT_GT(radiosity.mesh.elements().size(), 4 * patches) << "nothing to take over";
        const auto then = sorted_places(before), now = sorted_places(extract_solution(radiosity));
        EXPECT_TRUE(std::includes(now.begin(), now.end(), then.begin(), then.end()));
        // Dividing evens out more than merging left even.
        EXPECT_LE(now.size(), (merge ? 1.03 : 1.0) * double(then.size()));
        ASSERT_EQ(patch_of.size(), before.triangles.size());
        for (const PatchId patch : patch_of) EXPECT_TRUE(patch.valid());
    }
}

TEST(Resume, TakesOverWhatOtherPatchesWereDividedInto) {
    const Scene scene = varied_room();
    SolveOptions options = to_error(0.03);
    options.patch_size = 0.5;
    const Solution before = light(scene, options);
    Radiosity radiosity(scene, make_groups(scene, Grouping::file), MeshOptions::of_patches(0.31));
    take_over_mesh(radiosity, before);
    const Solution after = extract_solution(radiosity);
    // As fine everywhere, within the factor of two either way, and not much finer; smooth parts are
    // as fine as the smaller patches.
    EXPECT_GT(after.triangles.size(), before.triangles.size() / 2);
    EXPECT_LT(after.triangles.size(), 3 * before.triangles.size());
}

TEST(Resume, WithoutTimeTheLightStays) {
    const Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.1));
    Resumption from{before};
    SolveOptions options = to_error(0.005);
    options.time = 0.0;
    const Solution after = resumed(scene, options, from);
    EXPECT_EQ(from.outcome, Outcome::kept);
    expect_same(after, before);
    EXPECT_EQ(after.error->rms, before.error->rms);
    EXPECT_EQ(after.options, before.options);
    EXPECT_EQ(after.energy.absorbed, before.energy.absorbed);
}

TEST(Resume, WhatIsGoodEnoughIsNotTouched) {
    const Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.05));
    ASSERT_LE(before.error->rms, 0.05);
    Resumption from{before};
    int steps = 0;
    const Solution after =
        resumed(scene, to_error(0.05), from, nullptr, [&](const Progress&) { ++steps; });
    EXPECT_EQ(from.outcome, Outcome::sufficient);
    EXPECT_EQ(steps, 0);
    expect_same(after, before);
}

TEST(Resume, ReachesALesserError) {
    const Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.1));
    ASSERT_GT(before.error->rms, 0.01);
    Resumption from{before};
    const Solution after = resumed(scene, to_error(0.01), from);
    EXPECT_EQ(from.outcome, Outcome::improved);
    EXPECT_LE(after.error->rms, 0.01);
    EXPECT_LT(std::abs(after.energy.imbalance()), 0.01);
    EXPECT_EQ(after.options.at("error"), "0.01");
}

TEST(Resume, StoppedAnywhereItIsNeverWorse) {
    const Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.03));
    bool kept = false, improved = false;
    for (int stop = 1; stop < 12; stop += 2) {
        Cancel cancel;
        int seen = 0;
        Resumption from{before};
        const Solution after =
            resumed(scene, to_error(0.01), from, &cancel, [&](const Progress& progress) {
                EXPECT_TRUE(progress.error);
                if (++seen == stop) cancel.request();
            });
        EXPECT_LE(after.error->rms, before.error->rms) << stop;
        kept = kept || from.outcome == Outcome::kept;
        improved = improved || from.outcome == Outcome::improved;
        if (from.outcome == Outcome::kept) expect_same(after, before);
    }
    EXPECT_TRUE(kept) << "direct light alone is not better";
    EXPECT_TRUE(improved);
}

// What a demand has led to is known, and it is not made again.
TEST(Resume, GoesOnWithTheNextDemand) {
    const Scene scene = two_lamp_room();
    SolveOptions options = to_error(0.01);
    options.min_area = 0.2;  // takes more than one demand
    std::vector<std::optional<double>> errors;
    const auto count = [&](const Progress& progress) { errors.push_back(progress.error); };
    light(scene, options, count);
    const auto first_end =
        std::find_if(errors.begin(), errors.end(), [](const auto& e) { return e.has_value(); });
    ASSERT_NE(first_end, errors.end()) << "the first demand was enough";
    const auto first_steps = static_cast<int>(first_end - errors.begin());
    Cancel cancel;
    int seen = 0;
    const Solution stopped = light(
        scene, options,
        [&](const Progress&) {
            if (++seen == first_steps + 1) cancel.request();
        },
        &cancel);
    ASSERT_TRUE(stopped.counters.contains("demand"));
    const double demanded = stopped.counters.at("demand");
    EXPECT_DOUBLE_EQ(demanded, 1.4 * 0.01);
    Resumption from{stopped};
    const Solution after = resumed(scene, options, from);
    EXPECT_LE(after.error->rms, stopped.error->rms);
    if (from.outcome == Outcome::improved) {
        EXPECT_LE(after.counters.at("demand"), 0.8 * demanded);
    }
}

Scene seen_room() {
    Scene scene = two_lamp_room();
    Camera camera;
    camera.name = "corner";
    camera.eye = {2.7, 1.7, 1.5}, camera.look_at = {2.0, 0.5, 0.0};
    camera.up = {0, 0, 1};
    scene.cameras.push_back(camera);
    return scene;
}

TEST(Resume, WhatWasRefinedForACameraIsJudgedAnewElsewhere) {
    const Scene scene = seen_room();
    const auto to_error_for_camera = [](double error) {
        SolveOptions options = to_error(error);
        options.view = "corner";
        return options;
    };
    SolveOptions options = to_error_for_camera(0.02);
    const Solution for_camera = light(scene, options);
    ASSERT_LE(for_camera.error->rms, 0.02);
    Resumption from{for_camera};
    const Solution everywhere = resumed(scene, to_error(0.02), from);
    EXPECT_EQ(from.outcome, Outcome::improved) << "elsewhere it is rough";
    EXPECT_FALSE(everywhere.refined_for);
    EXPECT_LE(everywhere.error->rms, 0.02);

    // Which is good enough for the camera, too: nothing is refined, and so nothing is called so.
    Resumption back{everywhere};
    const Solution again = resumed(scene, to_error_for_camera(0.05), back);
    EXPECT_EQ(back.outcome, Outcome::sufficient);
    EXPECT_FALSE(again.refined_for);
    EXPECT_EQ(again.error->rms, everywhere.error->rms);
    expect_same(again, everywhere);

    // Or it is made so.
    Resumption further{everywhere};
    const Solution finer = resumed(scene, to_error_for_camera(0.002), further);
    EXPECT_EQ(further.outcome, Outcome::improved);
    ASSERT_TRUE(finer.refined_for);
    EXPECT_EQ(finer.refined_for->camera, "corner");
    EXPECT_LE(finer.error->rms, 0.002);

    // Without time it stays what it was, label and all.
    Resumption kept{for_camera};
    options.view.reset(), options.time = 0.0;
    const Solution same = resumed(scene, options, kept);
    EXPECT_EQ(kept.outcome, Outcome::kept);
    ASSERT_TRUE(same.refined_for);
    EXPECT_EQ(same.error->rms, for_camera.error->rms);
}

TEST(Resume, RefusesWhatIsNotItsOwn) {
    const Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.2));
    const auto message = [&](const Scene& now, const SolveOptions& options) -> std::string {
        Resumption from{before};
        try {
            resumed(now, options, from);
        } catch (const Error& error) {
            return error.what();
        }
        return "nothing";
    };
    Scene repainted = scene;
    repainted.materials[0].reflectance.assign(3, 0.25);
    EXPECT_NE(message(repainted, to_error(0.1))
                  .find("material 'room' reflects 0.6 0.6 0.6, "
                        "expected 0.25 0.25 0.25"),
              std::string::npos)
        << message(repainted, to_error(0.1));
    EXPECT_NE(message(two_lamp_room(false), to_error(0.1)).find("materials"), std::string::npos);
    Scene moved = scene;
    moved.points[0].x -= 0.1;
    EXPECT_NE(message(moved, to_error(0.1)).find("geometry"), std::string::npos);
    SolveOptions together = to_error(0.1);
    together.groups = "none";
    EXPECT_NE(message(scene, together).find("'warm', 'cold', and this solve 'all'"),
              std::string::npos);
    SolveOptions shooting = to_error(0.1);
    shooting.solver = "shooting";
    EXPECT_NE(message(scene, shooting).find("what is still to be distributed is not in a file"),
              std::string::npos);
}

TEST(Resume, OtherWeightsOfGroupsAreJudgedAnew) {
    Scene scene = two_lamp_room();
    const Solution before = light(scene, to_error(0.05));
    Resumption from{before};
    from.from.groups[0].weight = 0;  // as if it had been solved with that lamp off
    from.from.error->rms = 1e-6;     // which says nothing of both
    const Solution after = resumed(scene, to_error(0.05), from);
    EXPECT_GT(after.error->rms, 1e-5);
    EXPECT_EQ(after.groups[0].weight, 1);
}

}  // namespace
}  // namespace exitance
