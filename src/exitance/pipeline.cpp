// SPDX-License-Identifier: Apache-2.0
#include "exitance/pipeline.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
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
    MeshOptions out;
    out.patch_size = options.patch_size.value_or(
        std::max(1e-9, 0.05 * extent * std::sqrt(options.error / 0.02)));
    // Shorter contacts are left to the elements: light gets round what stands on them.
    out.shortest_contact = 0.25 * out.patch_size;
    return out;
}

double min_area(const SolveOptions& options, double error, double extent) {
    const double smallest = 0.1 * error * extent;
    return options.min_area.value_or(smallest * smallest);
}

ShootingOptions shooting_options(const SolveOptions& options, double extent) {
    ShootingOptions out;
    out.error = options.error;
    out.min_area = min_area(options, options.error, extent);
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

std::map<std::string, std::string> used(SolveOptions options) {
    std::map<std::string, std::string> out;
    for (const Option& option : describe(options))
        if (option.name != "threads")  // the bytes do not depend on it
            out[option.name] = option.value_text();
    return out;
}

void require_polygons(const Scene& scene) {
    if (scene.polygons.empty())
        throw Error(Fault::bad_input, "the scene has no polygons, expected something to light");
}

/// What is demanded of a solver. It does what should lead to the error asked for; held-out points
/// tell whether it did, and if not, more is demanded while that helps.
struct Demand {
    double error;
    double found = INFINITY;  ///< by the held-out points, the last time

    bool rise(const SolveOptions& options, const Radiosity& radiosity) {
        constexpr double least = 0.1, worthwhile = 0.9;
        if (!options.adaptive || options.unshot || options.next_shot) return false;
        const auto estimate = estimate_error(extract_solution(radiosity), options.seed);
        if (!estimate || estimate->rms <= options.error) return false;
        if (estimate->rms > worthwhile * found || error <= least * options.error) return false;
        found = estimate->rms;
        error *= std::clamp(0.8 * options.error / found, 0.4, 0.8);
        return true;
    }
};

}  // namespace

Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe,
               const Cancel* cancel, const Snapshots& snapshots) {
    require_polygons(scene);
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
    const Stop stop{options.unshot, options.time, options.next_shot, cancel};
    const Observer watch = with_snapshots(observe, snapshots, radiosity, solver);
    Demand demand{options.error};
    while (run(solver, stop, clock, watch) == Ended::converged && demand.rise(options, radiosity))
        solver.demand(demand.error, min_area(options, demand.error, size));
    if (snapshots.take) take_snapshot(snapshots, radiosity, solver);
    const EnergyBalance energy = balance(radiosity, options.seed);
    if (options.merge) merge_smooth(radiosity, solver.negligible());

    Solution solution = extract_solution(radiosity);
    solution.energy = energy;
    solution.error = estimate_error(solution, options.seed);
    solution.options = used(options);
    solution.counters = {{"shots", static_cast<double>(solver.shots())},
                         {"rays", static_cast<double>(solver.rays())},
                         {"vertices", static_cast<double>(radiosity.mesh.vertices().size())},
                         {"patches", static_cast<double>(radiosity.mesh.patches().size())},
                         {"elements", static_cast<double>(radiosity.mesh.elements().size())},
                         {"bytes", static_cast<double>(radiosity.bytes())}};
    return solution;
}

}  // namespace exitance
