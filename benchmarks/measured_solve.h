// SPDX-License-Identifier: Apache-2.0
// One solve as the program does it, from the scene in memory to the solution in memory, with what
// it cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"
#include "exitance/solve/options.h"

namespace exitance::benchmarks {

/// What a benchmark is asked for: SCENE [--bounces N] [--repeat N] [--OPTION VALUE]..., the options
/// those of a solve. Throws Error(wrong_use).
struct Request {
    std::filesystem::path scene;
    SolveOptions options;
    std::optional<std::uint64_t> bounces;  ///< stop when so many patches have shot
    int repeat = 1;

    Request(int argc, const char* const* argv);
};

struct Cost {
    double cpu = 0, wall = 0;  ///< the whole solve [s]
    double first_cpu = 0;      ///< of it, until the lamps have shone and the mesh is refined [s]
    double bounce_cpu = 0;     ///< of it, the shots of patches [s]
    double shots = 0, bounces = 0, rays = 0;
    double vertices = 0, elements = 0;
    double bytes = 0;             ///< mesh, fields and receivers
    double unshot = 0;            ///< share of the emitted light
    double imbalance = 0;         ///< of the energy, a share
    std::optional<double> error;  ///< as the solution estimates it
};

/// Processor time of this process, user and system [s].
double cpu_seconds();
/// Most memory that this process has held [bytes].
double peak_resident_bytes();

Cost measure_solve(const Scene& scene, const Request& request);

/// The one of `request.repeat` solves that took least processor time: other programs on the machine
/// only ever add to it.
Cost cheapest_solve(const Scene& scene, const Request& request);

}  // namespace exitance::benchmarks
