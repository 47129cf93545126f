// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/focus.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "exitance/math/box.h"
#include "exitance/render/camera_rays.h"
#include "exitance/run/error.h"
#include "exitance/solution/probe.h"
#include "exitance/solution/surface_probe.h"

namespace exitance {

namespace {

template <class Thing>
const Thing& named(const std::vector<Thing>& things, const std::string& name,
                   const std::string& kind) {
    std::vector<std::string> names;
    for (const Thing& thing : things) {
        if (thing.name == name) return thing;
        names.push_back(thing.name);
    }
    throw Error(Fault::wrong_use,
                names.empty() ? fmt::format("there is no {} '{}': the scene has none", kind, name)
                              : fmt::format("there is no {} '{}'{}; there are: {}", kind, name,
                                            suggestion(name, names), fmt::join(names, ", ")));
}

// Pages may be wider than the picture that is a camera's own.
constexpr double widest = 16.0 / 9.0;
// Of a finer grid so many stand for all.
constexpr std::uint32_t most_sensors_along = 64;

}  // namespace

Focus focus_of(const Scene& scene, const SolveOptions& options) {
    Focus out;
    if (options.view) {
        const Camera& camera = named(scene.cameras, *options.view, "camera");
        constexpr std::uint32_t height = 192;
        const auto width = static_cast<std::uint32_t>(
            std::clamp(height * camera.aspect.value_or(widest), 1.0, 4e3));
        const CameraRays rays(camera, width, height);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                out.sight.push_back({rays.eye(), rays.direction(x + 0.5, y + 0.5)});
    }
    if (options.grid) {
        SensorGrid grid = named(scene.grids, *options.grid, "grid");
        grid.columns = std::min(grid.columns, most_sensors_along);
        grid.rows = std::min(grid.rows, most_sensors_along);
        for (const auto& [point, normal] : sensor_points(grid))
            out.sensors.push_back({point, normal});
    }
    Box bounds;
    for (const Vec3& point : scene.points) bounds.add(point);
    out.reach = SurfaceProbeOptions{}.tolerance * length(bounds.size());
    return out;
}

}  // namespace exitance
