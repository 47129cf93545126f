// SPDX-License-Identifier: Apache-2.0
// How much of the time of a solve is Embree's own for the same rays, on one thread: one JSON object
// on stdout. The solve is timed on its own, then done again with its packets replayed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "exitance/pipeline.h"
#include "exitance/run/error.h"
#include "exitance/run/random.h"
#include "exitance/scene/read.h"
#include "exitance/solution/gather.h"
#include "floor/packet_replay.h"
#include "measured_solve.h"

namespace exitance::benchmarks {
namespace {

/// How many rays would do if every vertex were gathered once and the error, `rms` of the mean, were
/// nothing but the noise of that, σ(n) ~ n^-3/4 (stratified rays): n per vertex from two gathers of
/// 256 rays at the middles of 1 000 triangles.
double fewest_rays(const Solution& solution, double rms) {
    constexpr std::size_t trials = 1000;
    constexpr std::uint32_t rays = 256;
    const Surfaces surfaces(solution, Backs::black);
    std::vector<GatherPoint> points;
    for (std::size_t i = 0; i < trials; ++i) {
        const auto at = uniform(7, i) * static_cast<double>(solution.triangles.size());
        const auto t = static_cast<std::uint32_t>(at);
        const auto [a, b, c] = surfaces.corners(t);
        const Vec3 across = cross(b - a, c - a);
        if (length(across) > 0) points.push_back({(a + b + c) / 3.0, normalized(across)});
    }
    const std::size_t columns = solution.columns(), count = points.size();
    std::vector<double> first(count * columns), second(count * columns);
    gather(surfaces, points, first, {rays, 1024, 1});
    gather(surfaces, points, second, {rays, 1024, 2});
    double square = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = solution.luminance({&first[i * columns], columns});
        const double b = solution.luminance({&second[i * columns], columns});
        square += (a - b) * (a - b) / 2;
    }
    // Of the surface, as the error is.
    double mean = 0, area = 0;
    std::vector<double> light(columns);
    for (std::uint32_t t = 0; t < solution.triangles.size(); ++t) {
        const auto [a, b, c] = surfaces.corners(t);
        const double here = length(cross(b - a, c - a));
        surfaces.irradiance({t, {1.0 / 3, 1.0 / 3, 1.0 / 3}}, light);
        mean += here * solution.luminance(light), area += here;
    }
    mean /= area;
    const double sigma = std::sqrt(square / static_cast<double>(count)) / mean;
    return static_cast<double>(solution.positions.size()) * rays * std::pow(sigma / rms, 4.0 / 3.0);
}

}  // namespace
}  // namespace exitance::benchmarks

int main(int argc, char** argv) {
    using namespace exitance;
    using namespace exitance::benchmarks;
    try {
        Request request(argc, argv);
        request.options.threads = 1;
        const Scene scene = read_scene(request.scene);
        Cost solve;
        Replay floor;
        for (int i = 0; i < request.repeat; ++i) {  // in turns, so that both meet the same machine
            const Cost cost = measure_solve(scene, request);
            PacketReplay replay;
            measure_solve(scene, request);
            const Replay again = replay.finish();
            if (i == 0) {
                solve = cost;
                floor = again;
            }
            if (cost.cpu < solve.cpu) solve = cost;
            floor.occluded.seconds = std::min(floor.occluded.seconds, again.occluded.seconds);
            floor.closest.seconds = std::min(floor.closest.seconds, again.closest.seconds);
        }
        const auto json = [](const Replayed& r) {
            return nlohmann::ordered_json{{"packets", r.packets},
                                          {"rays", r.rays},
                                          {"seconds", r.seconds},
                                          {"replayed_share", r.share}};
        };
        nlohmann::ordered_json out{{"polygons", scene.polygons.size()},
                                   {"vertices", solve.vertices},
                                   {"rays", solve.rays},
                                   {"solve_cpu_seconds", solve.cpu},
                                   {"occluded", json(floor.occluded)},
                                   {"closest", json(floor.closest)}};
        if (!request.bounces) {
            const Solution solution = light(scene, request.options);
            if (solution.error && solution.error->rms > 0)
                out["fewest_rays"] = fewest_rays(solution, solution.error->rms);
        }
        std::puts(out.dump().c_str());
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
