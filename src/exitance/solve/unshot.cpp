// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/unshot.h"

#include <algorithm>

namespace exitance {

std::vector<float> unshot_at_vertices(const Radiosity& radiosity) {
    const Mesh& mesh = radiosity.mesh;
    const std::size_t stride = radiosity.columns.stride;
    std::vector<float> sum(mesh.vertices().size(), 0.0f), area(sum.size(), 0.0f), unshot(stride);
    for (const Patch& patch : mesh.patches())
        mesh.for_leaves(patch.root, [&](ElementId leaf) {
            radiosity.reflected_exitance(leaf, unshot);
            const auto shot = radiosity.shot[leaf];
            for (std::size_t c = 0; c < stride; ++c) unshot[c] -= shot[c];
            const float waits = std::max(0.0f, radiosity.columns.luminance(unshot));
            for (const VertexId v : mesh[leaf].corners()) {
                sum[v.index()] += mesh[leaf].area * waits;
                area[v.index()] += mesh[leaf].area;
            }
        });
    for (std::size_t v = 0; v < sum.size(); ++v)
        if (area[v] > 0) sum[v] /= area[v];
    return sum;
}

}  // namespace exitance
