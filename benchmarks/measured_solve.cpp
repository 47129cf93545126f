// SPDX-License-Identifier: Apache-2.0
#include "measured_solve.h"

#include <sys/resource.h>

#include <fstream>

#include "exitance/pipeline.h"
#include "exitance/run/error.h"

namespace exitance::benchmarks {

namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Request::Request(int argc, const char* const* argv) {
    const std::string usage = "SCENE [--bounces N] [--repeat N] [--OPTION VALUE]...";
    if (argc < 2 || argc % 2 != 0) throw Error(Fault::wrong_use, "expected " + usage);
    scene = argv[1];
    options.solver = "shooting";
    Options known = describe(options);
    std::uint64_t most_bounces = 0;
    known.push_back({"bounces", &most_bounces, "stop when so many patches have shot", "", 1});
    known.push_back({"repeat", &repeat, "solves of which the cheapest counts", "", 1});
    for (int i = 2; i < argc; i += 2) {
        const std::string name = argv[i];
        if (!name.starts_with("--")) throw Error(Fault::wrong_use, "expected " + usage);
        find_option(known, name.substr(2)).set(argv[i + 1]);
    }
    if (most_bounces > 0) bounces = most_bounces;
}

double cpu_seconds() {
    rusage now{};
    getrusage(RUSAGE_SELF, &now);
    return seconds(now.ru_utime) + seconds(now.ru_stime);
}

// Not ru_maxrss, which begins with what the process held that started this one.
double peak_resident_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return 1024.0 * std::stod(line.substr(6));
    throw Error(Fault::could_not_finish, "/proc/self/status does not say VmHWM");
}

Cost measure_solve(const Scene& scene, const Request& request) {
    Cost cost;
    Cancel cancel;
    std::optional<std::uint64_t> first_shots;
    const double begin = cpu_seconds();
    const Stopwatch clock;
    const Solution solution = light(
        scene, request.options,
        [&](const Progress& progress) {
            if (progress.phase == "estimate") return;
            const double now = cpu_seconds() - begin;
            if (!first_shots) {
                first_shots = progress.shots;
                cost.first_cpu = now;
            }
            cost.bounce_cpu = now - cost.first_cpu;
            const std::uint64_t bounces = progress.shots - *first_shots;
            cost.bounces = static_cast<double>(bounces);
            if (request.bounces && bounces >= *request.bounces) cancel.request();
        },
        &cancel);
    cost.wall = clock.seconds();
    cost.cpu = cpu_seconds() - begin;
    cost.shots = solution.counters.at("shots");
    cost.rays = solution.counters.at("rays");
    cost.vertices = solution.counters.at("vertices");
    cost.elements = solution.counters.at("elements");
    cost.bytes = solution.counters.at("bytes");
    if (solution.energy.emitted > 0) cost.unshot = solution.energy.unshot / solution.energy.emitted;
    cost.imbalance = solution.energy.imbalance();
    if (solution.error) cost.error = solution.error->rms;
    return cost;
}

Cost cheapest_solve(const Scene& scene, const Request& request) {
    Cost best = measure_solve(scene, request);
    for (int i = 1; i < request.repeat; ++i) {
        const Cost again = measure_solve(scene, request);
        if (again.cpu < best.cpu) best = again;
    }
    return best;
}

}  // namespace exitance::benchmarks
