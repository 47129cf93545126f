// SPDX-License-Identifier: Apache-2.0
// What it costs to light a scene by progressive shooting: one JSON object on stdout.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "exitance/run/error.h"
#include "exitance/scene/read.h"
#include "measured_solve.h"

int main(int argc, char** argv) {
    using namespace exitance;
    try {
        const benchmarks::Request request(argc, argv);
        const Scene scene = read_scene(request.scene);
        const double held_before = benchmarks::peak_resident_bytes();
        const benchmarks::Cost cost = benchmarks::cheapest_solve(scene, request);
        nlohmann::ordered_json out{{"polygons", scene.polygons.size()},
                                   {"vertices", cost.vertices},
                                   {"elements", cost.elements},
                                   {"shots", cost.shots},
                                   {"bounces", cost.bounces},
                                   {"rays", cost.rays},
                                   {"cpu_seconds", cost.cpu},
                                   {"wall_seconds", cost.wall},
                                   {"first_cpu_seconds", cost.first_cpu},
                                   {"bounce_cpu_seconds", cost.bounce_cpu},
                                   {"bytes", cost.bytes},
                                   {"resident_before", held_before},
                                   {"resident_peak", benchmarks::peak_resident_bytes()},
                                   {"unshot", cost.unshot},
                                   {"imbalance", cost.imbalance}};
        if (cost.error) out["error"] = *cost.error;
        std::puts(out.dump().c_str());
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
