// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_colours.h"

namespace exitance::solution_file {

const Pattern* shown_pattern(const Solution& solution, const Material& material) {
    if (solution.texture_coordinates.empty()) return nullptr;
    if (material.exitance_pattern) return &material.exitance_pattern;
    return material.reflectance_pattern ? &material.reflectance_pattern : nullptr;
}

Vec3f total_rgb(const Solution& solution, const SolutionPart& part, std::uint32_t vertex) {
    const std::size_t bands = solution.bands.size();
    const Spectrum luminances = bands == 3 ? Spectrum{} : luminance_weights(bands);
    Vec3 rgb;
    for (std::size_t g = 0; g < solution.groups.size(); ++g)
        for (std::size_t b = 0; b < bands; ++b) {
            const double B =
                solution.groups[g].weight * double(solution.exitance(vertex, part, g * bands + b));
            if (bands == 3)
                rgb[b] += B;
            else
                rgb += Vec3{B, B, B} * luminances[b];
        }
    return Vec3f(rgb);
}

Vec3f brightest_rgb(const Solution& solution, const SolutionPart& part, std::uint32_t vertex) {
    const Material& material = solution.materials[part.material];
    const Pattern* shown = shown_pattern(solution, material);
    if (!shown) return total_rgb(solution, part, vertex);
    Vec3 rgb;
    const std::uint32_t lit = part.group;
    for (std::size_t b = 0; b < 3; ++b) {
        const bool reflects = shown == &material.reflectance_pattern;
        const double rho = reflects ? shown->factor[b] : material.reflectance[b];
        for (std::size_t g = 0; g < solution.groups.size(); ++g)
            rgb[b] += solution.groups[g].weight * rho *
                      double(solution.irradiance[VertexId(vertex)][g * 3 + b]);
        rgb[b] +=
            solution.groups[lit].weight * (reflects ? material.exitance[b] : shown->factor[b]);
    }
    return Vec3f(rgb);
}

}  // namespace exitance::solution_file
