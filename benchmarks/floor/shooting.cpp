// SPDX-License-Identifier: Apache-2.0
// How much of the time of a solve is Embree's own for the same rays, on one thread: one JSON object
// on stdout. The solve is timed on its own, then done again with its packets replayed.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "exitance/run/error.h"
#include "exitance/scene/read.h"
#include "floor/packet_replay.h"
#include "measured_solve.h"

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
        const nlohmann::ordered_json out{{"polygons", scene.polygons.size()},
                                         {"vertices", solve.vertices},
                                         {"shots", solve.shots},
                                         {"solve_cpu_seconds", solve.cpu},
                                         {"occluded", json(floor.occluded)},
                                         {"closest", json(floor.closest)}};
        std::puts(out.dump().c_str());
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
