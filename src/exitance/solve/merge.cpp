// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/merge.h"

#include <cmath>
#include <vector>

namespace exitance {

namespace {

bool is_smooth(const Radiosity& radiosity, const Element& parent, float tolerance) {
    const Mesh& mesh = radiosity.mesh;
    const std::size_t stride = radiosity.columns.stride;
    const bool open = radiosity.exposed[parent.vertices[0].index()];
    for (const VertexId v : parent.corners())
        if (bool(radiosity.exposed[v.index()]) != open) return false;
    std::vector<float> mean(stride, 0.0f);
    for (const VertexId v : parent.corners())
        for (std::size_t c = 0; c < stride; ++c)
            mean[c] += radiosity.irradiance[v][c] / static_cast<float>(parent.count);

    const auto middle = Mesh::midpoints(parent);
    const Face& face = mesh.face_of(parent);
    for (std::uint32_t i = 0; i < middle.count; ++i) {
        const auto vertex = mesh.find_vertex(face, middle.at[i][0], middle.at[i][1]);
        if (!vertex || bool(radiosity.exposed[vertex->index()]) != open) return false;
        const auto H = radiosity.irradiance[*vertex];
        float difference = 0;
        for (std::size_t c = 0; c < stride; ++c) {
            float expected = mean[c];
            if (i < parent.count)
                expected =
                    0.5f * (radiosity.irradiance[parent.vertices[i]][c] +
                            radiosity.irradiance[parent.vertices[(i + 1) % parent.count]][c]);
            difference += radiosity.columns.weight[c] * std::abs(H[c] - expected);
        }
        if (difference > tolerance) return false;
    }
    return true;
}

}  // namespace

std::size_t merge_smooth(Radiosity& radiosity, float tolerance) {
    std::size_t merged = 0;
    for (int level = Mesh::max_level - 1; level >= 0; --level) {
        for (std::size_t e = 0; e < radiosity.mesh.elements().size(); ++e) {
            const ElementId id(e);
            const Element& element = radiosity.mesh[id];
            if (element.level != level || element.leaf() || !radiosity.mesh.can_merge(id)) continue;
            if (!is_smooth(radiosity, element, tolerance)) continue;
            radiosity.mesh.merge(id);
            ++merged;
        }
    }
    return merged;
}

}  // namespace exitance
