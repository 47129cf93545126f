// SPDX-License-Identifier: Apache-2.0
#include "grid_readings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "exitance/solution/probe.h"

namespace exitance::cli {

namespace {

constexpr std::size_t most_points = 20000;

/// Irradiance, points × columns: read off surfaces, gathered where there is none.
std::vector<double> readings(const Solution& solution, const std::vector<GatherPoint>& points) {
    std::vector<double> E = probe(solution, points);
    const std::size_t columns = solution.columns();
    std::vector<std::size_t> free;
    std::vector<GatherPoint> in_free_space;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (std::isnan(E[i * columns])) free.push_back(i), in_free_space.push_back(points[i]);
    ProbeOptions options;
    options.method = "gather";
    options.rays = 256;  // about 0.6 %: finer than the solution usually is
    const std::vector<double> gathered = probe(solution, in_free_space, options);
    for (std::size_t k = 0; k < free.size(); ++k)
        std::copy_n(gathered.begin() + std::ptrdiff_t(k * columns), columns,
                    E.begin() + std::ptrdiff_t(free[k] * columns));
    return E;
}

}  // namespace

std::string grid_readings(const Solution& solution) {
    const std::size_t bands = solution.bands.size();
    nlohmann::json out = nlohmann::json::array();
    for (const SensorGrid& grid : solution.grids) {
        if (std::uint64_t{grid.columns} * grid.rows > most_points) {
            out.push_back(nullptr);
            continue;
        }
        const std::vector<double> E = readings(solution, sensor_points(grid));
        nlohmann::json values = nlohmann::json::array();
        for (std::size_t at = 0; at < E.size(); at += bands) {
            double mean = 0;
            for (std::size_t b = 0; b < bands; ++b) mean += E[at + b] / static_cast<double>(bands);
            for (std::size_t c = 0; c < 3; ++c)
                values.push_back(static_cast<float>(bands == 3 ? E[at + c] : mean));
        }
        out.push_back(std::move(values));
    }
    return out.dump();
}

}  // namespace exitance::cli
