// SPDX-License-Identifier: Apache-2.0
// Irradiance at points, by whichever method is asked for.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/run/options.h"
#include "exitance/solution/gather.h"
#include "exitance/solution/surface_probe.h"

namespace exitance {

struct ProbeOptions {
    std::string method = "interpolate";
    double tolerance = SurfaceProbeOptions{}.tolerance;
    int rays = 1024;
    std::uint64_t seed = 0;
};

/// Every member of `options` with its name, unit, range and reason.
Options describe(ProbeOptions& options);

/// Irradiance at each point on the side of its normal, points × solution columns
/// [irradiance_unit]; NaN where interpolation finds no surface.
std::vector<double> probe(const Solution& solution, std::span<const GatherPoint> points,
                          const ProbeOptions& options = {});

/// The sensors of a grid, row by row: origin + (i + ½)/columns · u + (j + ½)/rows · v.
std::vector<GatherPoint> sensor_points(const SensorGrid& grid);

}  // namespace exitance
