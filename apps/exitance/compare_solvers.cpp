// SPDX-License-Identifier: Apache-2.0
#include "compare_solvers.h"

#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "exitance/math/polygon.h"
#include "exitance/pipeline.h"
#include "exitance/scene/spectrum.h"
#include "exitance/solution/surface_probe.h"
#include "exitance/solution/surfaces.h"
#include "exitance/solve/element_methods.h"
#include "human_number.h"

namespace exitance::cli {

namespace {

// At the middles of the reference's triangles, by area.
double rms_difference(const Solution& solution, const Solution& reference) {
    const Surfaces ours(solution, Backs::black), theirs(reference, Backs::black);
    double square = 0, sum = 0, all = 0;
    std::vector<double> here(solution.columns()), there(reference.columns());
    for (std::uint32_t t = 0; t < reference.triangles.size(); ++t) {
        const auto corners = theirs.corners(t);
        const Vec3 middle = centroid(corners), normal = unit_normal(corners);
        if (!probe_surface(ours, middle, normal, here) ||
            !probe_surface(theirs, middle, normal, there))
            continue;
        const double a = area(corners), light = reference.luminance(there);
        const double difference = solution.luminance(here) - light;
        square += a * difference * difference, sum += a * light, all += a;
    }
    return sum > 0 ? std::sqrt(square / all) / (sum / all) : 0.0;
}

struct Run {
    Solution solution;
    double cpu_seconds = 0;
};

Run run(const Scene& scene, const SolveOptions& options, const Cancel& cancel) {
    const std::clock_t before = std::clock();
    Solution solution = light(scene, options, {}, &cancel);
    return {std::move(solution), double(std::clock() - before) / CLOCKS_PER_SEC};
}

std::string row(const SolveOptions& options, const Run& done, const Solution& reference) {
    const auto count = [&](const char* name) {
        const auto found = done.solution.counters.find(name);
        return found == done.solution.counters.end() ? std::string("-")
                                                     : fmt::format("{:.3g}", found->second);
    };
    const auto& counters = done.solution.counters;
    const auto transport = counters.find("transport_bytes");
    const double bytes =
        counters.at("bytes") + (transport == counters.end() ? 0.0 : transport->second);
    const std::string error =
        done.solution.error ? fmt::format("{:.2f}", 100 * done.solution.error->rms) : "-";
    return fmt::format("{:<13} {:<11} {:>7} {:>9} {:>8.2f} {:>9} {:>8} {:>10.3f} {:>9.1f}\n",
                       solver_of(options), options.transport.value_or("on-the-fly"),
                       count("sweeps"), human_count(counters.at("rays")), done.cpu_seconds,
                       count("residual"), error, 100 * rms_difference(done.solution, reference),
                       bytes / 1e6);
}

}  // namespace

std::string compare_solvers(const Scene& scene, const SolveOptions& options, const Cancel& cancel) {
    SolveOptions exact = options;
    exact.solver = "krylov", exact.unshot = 1e-7;
    exact.transport.reset(), exact.min_area.reset();
    const Solution reference = run(scene, exact, cancel).solution;
    std::string table =
        "solver        transport    sweeps      rays    CPU s  residual  error %  RMS diff %       "
        " "
        "MB\n";
    const auto add = [&](std::string_view solver, std::optional<std::string> transport) {
        if (cancel.requested()) return;
        SolveOptions one = options;
        one.solver = solver, one.transport = std::move(transport);
        table += row(one, run(scene, one, cancel), reference);
    };
    if (!options.transport) add(adaptive_shooting, {});
    if (!options.transport && !options.unshot && options.overshoot) add(adaptive_gathering, {});
    for (const ElementMethod& method : element_methods())
        for (const std::string_view transport : transports)
            if ((!options.transport || *options.transport == transport) &&
                go_together(method, transport) && (!options.min_area || transport == "links"))
                add(method.name, std::string(transport));
    return table;
}

}  // namespace exitance::cli
