// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/probe.h"

#include <limits>

#include "exitance/run/parallel.h"
#include "exitance/solution/surface_probe.h"

namespace exitance {

Options describe(ProbeOptions& o) {
    return {
        {"method",
         &o.method,
         "interpolate reads the solved surface at the point; gather integrates over the hemisphere "
         "and works in free space",
         "",
         0,
         0,
         {"interpolate", "gather"}},
        {"tolerance", &o.tolerance,
         "interpolate: how far a point may lie from its surface, in diagonals of the scene", "", 0,
         1},
        {"rays", &o.rays,
         "gather: rays over the hemisphere, and to each partly hidden lamp; the error falls to "
         "half "
         "with three times as many",
         "", 16, 1 << 24},
        {"seed", &o.seed, "gather: seed of the random numbers; same seed, same bytes"},
    };
}

std::vector<double> probe(const Solution& solution, std::span<const GatherPoint> points,
                          const ProbeOptions& options) {
    const std::size_t columns = solution.columns();
    std::vector<double> out(points.size() * columns, std::numeric_limits<double>::quiet_NaN());
    const Surfaces surfaces(solution, Backs::black);
    if (options.method == "gather") {
        const auto rays = static_cast<std::uint32_t>(options.rays);
        gather(surfaces, points, out,
               {.hemisphere_rays = rays, .emitter_rays = rays, .seed = options.seed});
    } else {
        parallel_for(points.size(), [&](std::size_t i) {
            probe_surface(surfaces, points[i].position, points[i].normal,
                          std::span(out).subspan(i * columns, columns),
                          {.tolerance = options.tolerance});
        });
    }
    return out;
}

std::vector<GatherPoint> sensor_points(const SensorGrid& grid) {
    std::vector<GatherPoint> out;
    for (std::uint32_t j = 0; j < grid.rows; ++j)
        for (std::uint32_t i = 0; i < grid.columns; ++i)
            out.push_back({grid.origin + grid.u * ((i + 0.5) / grid.columns) +
                               grid.v * ((j + 0.5) / grid.rows),
                           normalized(grid.normal)});
    return out;
}

}  // namespace exitance
