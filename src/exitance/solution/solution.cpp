// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/solution.h"

namespace exitance {

double Solution::luminance(std::span<const double> values) const {
    const Spectrum band_weight = luminance_weights(bands.size());
    double sum = 0;
    for (std::size_t c = 0; c < values.size(); ++c)
        sum += groups[c / bands.size()].weight * band_weight[c % bands.size()] * values[c];
    return sum;
}

float Solution::exitance(std::size_t vertex, const SolutionPart& part, std::size_t column) const {
    const Material& material = materials[part.material];
    const std::size_t group = column / bands.size(), band = column % bands.size();
    const double E = group == part.group ? material.exitance[band] : 0.0;
    const double H = double(irradiance[VertexId(vertex)][column]);
    return static_cast<float>(E + material.reflectance[band] * H);
}

void Solution::exitance(std::size_t vertex, const SolutionPart& part, std::span<float> out) const {
    for (std::size_t column = 0; column < columns(); ++column)
        out[column] = exitance(vertex, part, column);
}

}  // namespace exitance
