// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "human_number.h"
#include "scene_report.h"
#include "summary.h"

namespace exitance::cli {

SolutionReport::SolutionReport(Solution solution, std::filesystem::path file)
    : solution_(std::move(solution)), file_(std::move(file)) {
    for (const Vec3f& position : solution_.positions) bounds_.add(Vec3(position));
}

std::string SolutionReport::text() const {
    const Vec3 size = bounds_.size();
    std::string out = fmt::format(
        "{}\n{}: a solved scene, irradiance at every vertex\n\n"
        "Mesh: {}, {}, {}\n"
        "  {:.4g} × {:.4g} × {:.4g} m\n\nLight groups: {}\n",
        solution_.title, file_.string(), plural(solution_.positions.size(), "vertex", "vertices"),
        plural(solution_.triangles.size(), "triangle", "triangles"),
        plural(solution_.materials.size(), "material", "materials"), size.x, size.y, size.z,
        solution_.groups.size());
    for (const LightGroup& group : solution_.groups)
        out += group.weight == 1 ? fmt::format("  {}\n", group.name)
                                 : fmt::format("  {}, dimmed to {:g}\n", group.name, group.weight);

    const EnergyBalance energy = shown(solution_.energy);
    const auto flux = [&](double value) {
        return human_quantity(value, flux_unit(solution_.quantity));
    };
    out += fmt::format(
        "\nEnergy: {} emitted\n  {} absorbed, {} absorbed by backs and lamps, {} escaped, {} still "
        "unshot\n",
        flux(energy.emitted), flux(energy.absorbed), flux(energy.absorbed_behind),
        flux(energy.escaped), flux(energy.unshot));
    if (solution_.error)
        out += fmt::format("Error: {}\n", error_text(solution_));
    else
        out += "Error: not estimated\n";
    const auto aim = aim_of(solution_);
    const std::string unreached = aim ? unreached_text(solution_, *aim) : "";
    if (!unreached.empty()) out += fmt::format("  {}\n", unreached);
    const std::string stopped = stopped_text(solution_);
    const bool told = aim && reached(solution_, *aim) == false;
    if (!stopped.empty() && !told) out += fmt::format("  {}\n", stopped);

    if (solution_.refined_for)
        out += fmt::format("Refined for {}: rough elsewhere, not view-independent\n",
                           focus_text(*solution_.refined_for));

    if (const std::string memory = memory_text(solution_); !memory.empty())
        out += fmt::format("Memory: {}\n", memory);
    if (!solution_.cameras.empty()) out += "\n";
    for (const Camera& camera : solution_.cameras) out += fmt::format("Camera {}\n", camera.name);
    for (const SensorGrid& grid : solution_.grids)
        out += fmt::format("Grid {}: {} × {} points\n", grid.name, grid.columns, grid.rows);
    for (const LightScene& scene : solution_.light_scenes) out += scene_text(scene);
    if (!solution_.options.empty()) out += "\nSolved with\n";
    for (const auto& [name, value] : solution_.options)
        if (!value.empty()) out += fmt::format("  {} = {}\n", name, value);
    return out;
}

}  // namespace exitance::cli
