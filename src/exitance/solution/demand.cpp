// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/demand.h"

#include <algorithm>

#include "exitance/solution/extract.h"

namespace exitance {

namespace {

// What the solver was done with before it was stopped; a file carries it for --resume.
constexpr const char* demand_counter = "demand";

// What leads to the error asked for, if errors follow demands.
double next_demand(double last, double found, const SolveOptions& options) {
    return last * std::clamp(0.8 * options.error / found, 0.4, 0.8);
}

// What is small and wrong few points show, and leave much doubt.
double worst_likely(const ErrorEstimate& estimate) {
    return estimate.rms + estimate.confidence;
}

std::map<std::string, double> counters_of(const Radiosity& radiosity) {
    return {{"vertices", static_cast<double>(radiosity.mesh.vertices().size())},
            {"patches", static_cast<double>(radiosity.mesh.patches().size())},
            {"elements", static_cast<double>(radiosity.mesh.elements().size())},
            {"bytes", static_cast<double>(radiosity.bytes())}};
}

}  // namespace

Solution solution_of(const Radiosity& radiosity) {
    Solution out = extract_solution(radiosity);
    out.counters = counters_of(radiosity);
    return out;
}

Solution judged_solution_of(const Radiosity& radiosity, const SolveOptions& options,
                            const Importance* importance) {
    std::vector<PatchId> patches;
    Solution out = extract_solution(radiosity, {}, &patches);
    out.counters = counters_of(radiosity);
    std::optional<TriangleImportance> of_triangles;
    if (importance) of_triangles = importance_of(patches, *importance);
    out.error =
        estimate_error(out, options.seed, options.error, of_triangles ? &*of_triangles : nullptr);
    return out;
}

TriangleImportance importance_of(const std::vector<PatchId>& patches,
                                 const Importance& importance) {
    TriangleImportance out;
    const auto of = [](const std::vector<float>& values, PatchId patch) {
        return patch.valid() ? values[patch.index()] : 0.0f;
    };
    for (const PatchId patch : patches) {
        out.shown.push_back(of(importance.shown, patch));
        out.weight.push_back(of(importance.weight, patch));
        out.echo.push_back(of(importance.echo, patch));
    }
    return out;
}

bool Demand::met_by(const ErrorEstimate& estimate, const SolveOptions& options) const {
    return worst_likely(estimate) <= options.error;
}

void Demand::take_if_better(Solution now) {
    if (best && now.error && now.error->rms > best->rms) return;
    if (done) now.counters[demand_counter] = *done;
    best = now.error;
    solution = std::move(now);
    is_of_mesh = true;
}

bool Demand::rise(const SolveOptions& options, const Radiosity& radiosity) {
    constexpr double least = 0.1, worthwhile = 0.9;
    risen = false;
    if (!options.adaptive || options.unshot || options.next_shot) return false;
    done = error;
    Solution now = judged_solution_of(radiosity, options, importance);
    const std::optional<ErrorEstimate> estimate = now.error;
    take_if_better(std::move(now));
    if (!estimate || met_by(*estimate, options) || (is_last && is_last())) return false;
    const bool had_begun = error <= options.error;
    if (had_begun && worst_likely(*estimate) > worthwhile * found) return false;
    if (error <= least * options.error) return false;
    found = worst_likely(*estimate);
    error = next_demand(error, found, options);
    return risen = true;
}

void Demand::resume(const Solution& kept, const std::optional<ErrorEstimate>& estimate,
                    const SolveOptions& options) {
    best = estimate;
    risen = true;
    const auto counter = kept.counters.find(demand_counter);
    if (!estimate || counter == kept.counters.end() || !(counter->second > 0)) return;
    done = counter->second;
    const double needed = 0.8 * options.error / worst_likely(*estimate) * *done;
    error = std::clamp(needed, 0.4 * error, error);
}

}  // namespace exitance
