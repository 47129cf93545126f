// SPDX-License-Identifier: Apache-2.0
#include "exitance/pipeline.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cmath>

#include "exitance/run/error.h"
#include "exitance/solution/balance.h"
#include "exitance/solution/error_estimate.h"
#include "exitance/solution/extract.h"
#include "exitance/solve/merge.h"
#include "exitance/solve/shooting.h"

namespace exitance {

namespace {

Grouping grouping_of(const std::string& name) {
    if (name == "none") return Grouping::none;
    if (name == "luminaire") return Grouping::luminaire;
    if (name == "material") return Grouping::material;
    return Grouping::file;
}

// Length of the scene's surface, as it were: the side of a square of its area.
double extent(const Scene& scene) {
    double area = 0;
    for (const Polygon& polygon : scene.polygons) area += scene.area(polygon);
    return std::sqrt(area);
}

// The error asked for is spent on interpolation, whose part falls with the square of an element's
// size: patches shrink with its root. At 2 % a patch is a twentieth of the extent.
MeshOptions mesh_options(const SolveOptions& options, double extent) {
    return {options.patch_size.value_or(
                std::max(1e-9, 0.05 * extent * std::sqrt(options.error / 0.02))),
            true};
}

ShootingOptions shooting_options(const SolveOptions& options, double extent) {
    ShootingOptions out;
    out.error = options.error;
    const double smallest = 0.1 * options.error * extent;
    out.min_area = options.min_area.value_or(smallest * smallest);
    out.adaptive = options.adaptive;
    out.overshoot = options.overshoot;
    out.column.factor = options.form_factor == "disk" ? PointFactor::disk : PointFactor::lambert;
    out.column.occlusion = options.occlusion;
    out.column.seed = options.seed;
    return out;
}

void take_snapshot(const Snapshots& snapshots, const Radiosity& radiosity, const Shooting& solver) {
    Solution so_far = extract_solution(radiosity);
    if (snapshots.ambient) {
        const std::vector<float> ambient = solver.ambient();
        for (std::size_t v = 0; v < so_far.irradiance.rows(); ++v) {
            const auto row = so_far.irradiance[VertexId(v)];
            for (std::size_t c = 0; c < so_far.columns(); ++c) row[c] += ambient[c];
        }
    }
    snapshots.take(std::move(so_far));
}

Observer with_snapshots(const Observer& observe, const Snapshots& snapshots,
                        const Radiosity& radiosity, const Shooting& solver) {
    if (!snapshots.take || !snapshots.every) return observe;
    return [&, next = *snapshots.every](const Progress& progress) mutable {
        if (observe) observe(progress);
        if (progress.shots < next) return;
        next = progress.shots + *snapshots.every;
        take_snapshot(snapshots, radiosity, solver);
    };
}

}  // namespace

Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe,
               const Cancel* cancel, const Snapshots& snapshots) {
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0 ? static_cast<std::size_t>(options.threads)
                            : static_cast<std::size_t>(tbb::info::default_concurrency()));
    const Stopwatch clock;
    const double size = extent(scene);
    Radiosity radiosity(scene, make_groups(scene, grouping_of(options.groups)),
                        mesh_options(options, size));
    ShootingOptions shooting = shooting_options(options, size);
    shooting.interrupted = [&] {
        return (cancel && cancel->requested()) || (options.time && clock.seconds() > *options.time);
    };
    Shooting solver(radiosity, shooting);
    run(solver, {options.unshot, options.time, options.next_shot, cancel}, clock,
        with_snapshots(observe, snapshots, radiosity, solver));
    if (snapshots.take) take_snapshot(snapshots, radiosity, solver);
    const EnergyBalance energy = balance(radiosity, options.seed);
    if (options.merge) merge_smooth(radiosity, solver.negligible());

    Solution solution = extract_solution(radiosity);
    solution.energy = energy;
    solution.error = estimate_error(solution, options.seed);
    SolveOptions used = options;
    for (const Option& option : describe(used))
        if (option.name != "threads")  // the bytes do not depend on it
            solution.options[option.name] = option.value_text();
    solution.counters = {{"shots", static_cast<double>(solver.shots())},
                         {"rays", static_cast<double>(solver.rays())},
                         {"vertices", static_cast<double>(radiosity.mesh.vertices().size())},
                         {"patches", static_cast<double>(radiosity.mesh.patches().size())},
                         {"elements", static_cast<double>(radiosity.mesh.elements().size())},
                         {"bytes", static_cast<double>(radiosity.bytes())}};
    return solution;
}

}  // namespace exitance
