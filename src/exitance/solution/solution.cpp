// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/solution.h"

namespace exitance {

void Solution::exitance(std::size_t vertex, const SolutionPart& part, std::span<float> out) const {
    const Material& material = materials[part.material];
    const auto H = irradiance[VertexId(vertex)];
    for (std::size_t column = 0; column < columns(); ++column) {
        const std::size_t group = column / bands.size(), band = column % bands.size();
        const double E = group == part.group ? material.exitance[band] : 0.0;
        out[column] = static_cast<float>(E + material.reflectance[band] * double(H[column]));
    }
}

}  // namespace exitance
