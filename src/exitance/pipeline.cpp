// SPDX-License-Identifier: Apache-2.0
#include "exitance/pipeline.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>

#include "exitance/render/focus.h"
#include "exitance/run/error.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/solution/balance.h"
#include "exitance/solution/demand.h"
#include "exitance/solution/error_estimate.h"
#include "exitance/solution/extract.h"
#include "exitance/solution/resume.h"
#include "exitance/solve/divide.h"
#include "exitance/solve/element_methods.h"
#include "exitance/solve/element_solve.h"
#include "exitance/solve/gathering.h"
#include "exitance/solve/importance.h"
#include "exitance/solve/merge.h"
#include "exitance/solve/shooting.h"
#include "exitance/solve/unshot.h"

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
    return std::sqrt(scene.area());
}

// The error asked for is spent on interpolation, whose part falls with the square of an element's
// size: patches shrink with its root. At 2 % a patch is a twentieth of the extent.
MeshOptions mesh_options(const SolveOptions& options, double extent) {
    return MeshOptions::of_patches(options.patch_size.value_or(
        std::max(1e-9, 0.05 * extent * std::sqrt(options.error / 0.02))));
}

// Elements of one exitance each are wrong in proportion to their size.
std::optional<double> element_size(const SolveOptions& options, double extent) {
    if (options.element_size || !by_elements(options)) return options.element_size;
    return std::max(1e-9, 0.025 * extent * std::sqrt(options.error / 0.02));
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

ElementOptions element_options(const SolveOptions& options, double extent) {
    ElementOptions out;
    out.solver = solver_of(options);
    out.transport = options.transport;
    out.factors = options.factors;
    if (options.element_rays) out.rays = static_cast<int>(*options.element_rays);
    out.min_area = static_cast<float>(min_area(options, options.error, extent));
    out.divide = options.adaptive;
    out.gather_vertices = options.vertices.value_or("gather") == "gather";
    out.solving = {options.error, options.unshot, options.overshoot, options.seed};
    out.column.seed = options.seed;
    return out;
}

void take_snapshot(const Snapshots& snapshots, const Radiosity& radiosity, const Shooting* solver) {
    std::vector<float> unshot;
    if (snapshots.unshot && solver) unshot = unshot_at_vertices(radiosity);
    Solution so_far = extract_solution(radiosity, unshot);
    if (snapshots.ambient && solver) {
        const std::vector<float> ambient = solver->ambient();
        for (std::size_t v = 0; v < so_far.irradiance.rows(); ++v) {
            const auto row = so_far.irradiance[VertexId(v)];
            for (std::size_t c = 0; c < so_far.columns(); ++c) row[c] += ambient[c];
        }
    }
    snapshots.take(std::move(so_far));
}

Observer with_snapshots(const Observer& observe, const Snapshots& snapshots,
                        const Radiosity& radiosity, const Shooting* solver) {
    if (!snapshots.take || (!snapshots.every && !snapshots.wanted)) return observe;
    return [&observe, &snapshots, &radiosity, solver,
            next = snapshots.every](const Progress& progress) mutable {
        if (observe) observe(progress);
        const bool due = next && progress.shots >= *next;
        if (due) next = progress.shots + *snapshots.every;
        if (!due && !(snapshots.wanted && snapshots.wanted(progress))) return;
        take_snapshot(snapshots, radiosity, solver);
    };
}

// In a file: the vertices at which --memory ended the mesh, and the rays of a patch that it left.
constexpr const char *ended_by_memory = "vertices_by_memory",
                     *rays_by_memory = "patch_rays_by_memory";

double bytes_of(const Solution& s) {
    return double(s.positions.size() * (2 * sizeof(Vec3f) + sizeof(TextureCoordinates)) +
                  s.irradiance.bytes() + s.triangles.size() * sizeof(s.triangles[0]));
}

bool memory_ended(const Solution& solution) {
    return solution.counters.contains(ended_by_memory) ||
           solution.counters.contains(rays_by_memory);
}

double bytes_of_memory(const SolveOptions& options) {
    return options.memory.value_or(0) * 1e6;
}

std::optional<MemoryPlan> memory_plan(const SolveOptions& options, const Radiosity& radiosity,
                                      const Resumption* resumption) {
    if (!options.memory) return std::nullopt;
    return MemoryPlan(radiosity, bytes_of_memory(options),
                      resumption ? bytes_of(resumption->from) : 0);
}

std::map<std::string, std::string> used(SolveOptions options, bool ended) {
    options.solver = solver_of(options);
    std::map<std::string, std::string> out;
    for (const Option& option : describe(options)) {
        if (option.name == "threads") continue;           // the bytes do not depend on it
        if (option.name == "memory" && !ended) continue;  // nor on what is not needed
        const std::string value = option.value_text();
        if (value.empty() && !by_elements(options) && of_elements(option.name)) continue;
        out[option.name] = value;
    }
    return out;
}

void require_polygons(const Scene& scene) {
    if (scene.polygons.empty())
        throw Error(Fault::bad_input, "the scene has no polygons, expected something to light");
}

// Gathering usually does better than what is demanded of it, and goes on from a rough solution at
// little cost.
constexpr double first_demand = 1.4;

// Along a sharp shadow elements miss by the square root of their size: where more is demanded than
// at first, that has not been enough.
double min_area_demanded(const SolveOptions& options, double error, double extent) {
    return min_area(options, error * std::min(1.0, error / (first_demand * options.error)), extent);
}

/// What every way to solve is given.
struct Task {
    const SolveOptions& options;
    double size;
    Stop stop;
    const Stopwatch& clock;
    const Observer& observe;
    const Snapshots& snapshots;
    const Focus& focus;
    const MemoryPlan* memory = nullptr;  ///< if there is a limit
};

std::optional<RefinedFor> refined_for(const Task& task) {
    if (task.focus.empty()) return std::nullopt;
    return RefinedFor{task.options.view, task.options.grid};
}

std::function<bool()> interruption(const Task& task) {
    return [&task] { return task.stop.interruption(task.clock).has_value(); };
}

// Runs an adaptive solver to the error asked for, beginning with `demand`. Each demand after the
// first takes most of the time that is left.
template <class AdaptiveSolver>
Ended run_adaptively(AdaptiveSolver& solver, Radiosity& radiosity, const Task& task, Demand& demand,
                     const Shooting* shooting) {
    constexpr double share_of_rest = 0.7;
    const Observer watch = with_snapshots(task.observe, task.snapshots, radiosity, shooting);
    double left = 1;
    const Observer tell = [&](Progress progress) {
        if (demand.best) progress.error = demand.best->rms;
        if (!shooting)
            progress.fraction_left =
                left * (1 - share_of_rest + share_of_rest * progress.fraction_left);
        if (watch) watch(progress);
    };
    while (true) {
        const Ended ended = run(solver, task.stop, task.clock, tell);
        if (ended != Ended::converged || !demand.rise(task.options, radiosity)) return ended;
        if (!shooting && demand.is_of_mesh)
            demand.solution->energy = balance(radiosity, task.options.seed);
        demand.is_of_mesh = false;
        left *= 1 - share_of_rest;
        solver.demand(demand.error, min_area_demanded(task.options, demand.error, task.size));
    }
}

Solution shoot_adaptively(Radiosity& radiosity, const Task& task) {
    const SolveOptions& options = task.options;
    ShootingOptions shooting = shooting_options(options, task.size);
    shooting.interrupted = interruption(task);
    Shooting solver(radiosity, shooting);
    Demand demand{options.error};
    const Ended ended = run_adaptively(solver, radiosity, task, demand, &solver);
    if (task.snapshots.take) take_snapshot(task.snapshots, radiosity, &solver);
    const EnergyBalance energy = balance(radiosity, options.seed);
    if (options.merge) merge_smooth(radiosity, solver.negligible());
    Solution out = solution_of(radiosity);
    out.energy = energy;
    out.ended = ended;
    out.counters["shots"] = static_cast<double>(solver.shots());
    out.counters["rays"] = static_cast<double>(solver.rays());
    return out;
}

// What there is when gathering has ended: that which was looked at, or, if an interrupted step
// towards something better has not left something worse, what that has led to. Nothing if what is
// resumed was the best.
std::optional<Solution> gathered(Gathering& solver, Radiosity& radiosity, const Task& task,
                                 Demand& demand) {
    if ((!demand.best && !demand.solution) || (demand.risen && solver.has_light())) {
        solver.finish();
        const bool judge = demand.risen || demand.importance;
        demand.take_if_better(judge ? judged_solution_of(radiosity, task.options, demand.importance)
                                    : solution_of(radiosity));
    }
    if (!demand.solution || !demand.is_of_mesh) return std::move(demand.solution);
    demand.solution->energy = balance(radiosity, task.options.seed);
    if (task.snapshots.take) take_snapshot(task.snapshots, radiosity, nullptr);
    return std::move(demand.solution);
}

// Whether held-out points have looked at a solution where this solve would have them look, and
// closely enough: of what may be good enough as closely as it is asked for.
bool is_looked_at(const Solution& kept, const Task& task, const Demand& demand) {
    const SolveOptions& options = task.options;
    const RefinedFor there = kept.refined_for.value_or(RefinedFor{});
    if (!kept.error || there.camera != options.view || there.grid != options.grid) return false;
    const auto option = kept.options.find("error");
    const auto told = option == kept.options.end() ? std::nullopt : finite_number(option->second);
    return !demand.met_by(*kept.error, options) || (told && *told <= options.error);
}

// What held-out points say now of a solution that nothing is to be done for. It stays what it was
// refined for, and what was not refined for one place is not called so.
void judge(Solution& kept, const std::optional<ErrorEstimate>& found, bool same_weights,
           const Task& task) {
    const RefinedFor there = kept.refined_for.value_or(RefinedFor{});
    const bool as_before = there.camera == task.options.view && there.grid == task.options.grid;
    if (as_before || task.focus.empty()) {
        kept.error = found, kept.refined_for = refined_for(task);
    } else if (!same_weights) {
        kept.error.reset();
        if (!kept.refined_for)
            kept.error = estimate_error(kept, task.options.seed, task.options.error);
    }
}

// Takes the mesh of what is resumed over, and that itself as the best there is so far. Whether
// there is nothing left to do.
bool resume(Resumption& resumption, Radiosity& radiosity, const Task& task, Demand& demand) {
    const SolveOptions& options = task.options;
    Solution& kept = resumption.from;
    bool same_weights = true;
    for (std::size_t g = 0; g < kept.groups.size(); ++g)
        same_weights = same_weights && kept.groups[g].weight == radiosity.groups.groups[g].weight;
    describe_anew(kept, radiosity);
    const std::vector<PatchId> patches = take_over_mesh(
        radiosity, kept, task.memory ? task.memory->most_vertices_of_direct() : SIZE_MAX);
    std::optional<ErrorEstimate> estimate = kept.error;
    if (!same_weights || !is_looked_at(kept, task, demand)) {
        std::optional<TriangleImportance> weights;
        if (demand.importance) weights = importance_of(patches, *demand.importance);
        estimate = estimate_error(kept, options.seed, options.error, weights ? &*weights : nullptr);
    }
    resumption.outcome = Resumption::Outcome::kept;
    if (estimate && demand.met_by(*estimate, options)) {
        judge(kept, estimate, same_weights, task);
        resumption.outcome = Resumption::Outcome::sufficient;
        return true;
    }
    if (task.snapshots.take && task.snapshots.wanted) task.snapshots.take(kept);
    demand.resume(kept, estimate, options);
    return false;
}

Solution gather_adaptively(Radiosity& radiosity, const Task& task, Resumption* resumption) {
    const SolveOptions& options = task.options;
    Demand demand{options.adaptive ? first_demand * options.error : options.error};
    std::optional<Importance> importance;
    if (!task.focus.empty()) importance = find_importance(radiosity, task.focus, options.seed);
    demand.importance = importance ? &*importance : nullptr;
    if (resumption && resume(*resumption, radiosity, task, demand))
        return std::move(resumption->from);
    GatheringOptions gathering;
    gathering.error = demand.error;
    gathering.min_area = min_area_demanded(options, demand.error, task.size);
    gathering.adaptive = options.adaptive;
    gathering.merge = options.merge;
    gathering.column.seed = options.seed;
    gathering.column.most_rays = 512;
    gathering.interrupted = interruption(task);
    gathering.sketch = !resumption && (options.time || task.snapshots.wanted);
    gathering.importance = demand.importance;
    gathering.memory = task.memory;
    Gathering solver(radiosity, gathering);
    demand.is_last = [&] { return solver.is_full(); };
    Snapshots snapshots = task.snapshots;
    if (resumption && snapshots.wanted)  // shown until there is light everywhere again
        snapshots.wanted = [&](const Progress& progress) {
            return solver.has_light() && task.snapshots.wanted(progress);
        };
    const Task shown{options,      task.size, task.stop,  task.clock,
                     task.observe, snapshots, task.focus, task.memory};
    const Ended ended = run_adaptively(solver, radiosity, shown, demand, nullptr);
    if (resumption) resumption->ended = ended;
    std::optional<Solution> better = gathered(solver, radiosity, task, demand);
    if (!better) return std::move(resumption->from);
    better->ended = ended;
    if (resumption) resumption->outcome = Resumption::Outcome::improved;
    better->counters["rays"] = static_cast<double>(solver.rays());
    better->counters["shots"] = 0;
    if (solver.is_full())
        better->counters[ended_by_memory] = static_cast<double>(radiosity.mesh.vertices().size());
    if (const auto rays = solver.scarce_patch_rays()) better->counters[rays_by_memory] = *rays;
    better->counters["bytes"] = static_cast<double>(solver.bytes());
    return std::move(*better);
}

Solution solve_by_elements(Radiosity& radiosity, const Task& task) {
    ElementOptions elements = element_options(task.options, task.size);
    elements.light_meanwhile = bool(task.snapshots.take);
    const ElementReport report =
        solve_elements(radiosity, elements, task.stop, task.clock,
                       with_snapshots(task.observe, task.snapshots, radiosity, nullptr));
    const auto interrupted = task.stop.interruption(task.clock);
    if (task.snapshots.take) take_snapshot(task.snapshots, radiosity, nullptr);
    Solution out = solution_of(radiosity);
    out.ended = interrupted.value_or(Ended::converged);
    out.energy = balance(radiosity, task.options.seed);
    out.counters["rows"] = static_cast<double>(report.rows);
    out.counters["sweeps"] = report.sweeps;
    if (report.links) out.counters["links"] = static_cast<double>(*report.links);
    out.counters["residual"] = report.residual;
    out.counters["transport_bytes"] = static_cast<double>(report.bytes);
    out.counters["shots"] = static_cast<double>(report.shots);
    out.counters["rays"] = static_cast<double>(report.rays);
    return out;
}

}  // namespace

Solution light(const Scene& scene, const SolveOptions& options, const Observer& observe,
               const Cancel* cancel, const Snapshots& snapshots, Resumption* resumption) {
    require_polygons(scene);
    require_possible(options);
    if (resumption) require_resumable(options);
    const Focus focus = focus_of(scene, options);
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0 ? static_cast<std::size_t>(options.threads)
                            : static_cast<std::size_t>(tbb::info::default_concurrency()));
    const Stopwatch clock;
    const double size = extent(scene);
    const LightGroups groups = make_groups(scene, grouping_of(options.groups));
    if (resumption) require_same_light(resumption->from, scene, groups.groups);
    const MeshOptions patches = mesh_options(options, size);
    if (options.memory) require_memory(scene, patches.patch_size, bytes_of_memory(options));
    Radiosity radiosity(scene, groups, patches);
    const auto memory = memory_plan(options, radiosity, resumption);
    if (const auto longest = element_size(options, size)) divide_evenly(radiosity, *longest);
    const Task task{options,
                    size,
                    {options.unshot, options.time, options.next_shot, cancel},
                    clock,
                    observe,
                    snapshots,
                    focus,
                    memory ? &*memory : nullptr};
    Solution solution = solver_of(options) == adaptive_gathering
                            ? gather_adaptively(radiosity, task, resumption)
                        : by_elements(options) ? solve_by_elements(radiosity, task)
                                               : shoot_adaptively(radiosity, task);
    if (resumption && resumption->outcome != Resumption::Outcome::improved) return solution;
    solution.refined_for = refined_for(task);
    if (!solution.error) solution.error = estimate_error(solution, options.seed, options.error);
    solution.options = used(options, memory_ended(solution));
    return solution;
}

}  // namespace exitance
