// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/element_vertices.h"

#include <algorithm>
#include <numeric>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solve/cast_emission.h"

namespace exitance {

void average_at_vertices(Radiosity& radiosity, const ElementRows& rows,
                         const RowField& irradiance) {
    const Mesh& mesh = radiosity.mesh;
    const std::size_t stride = radiosity.columns.stride;
    std::vector<float> weight(mesh.vertices().size(), 0.0f);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const VertexId v : mesh[rows.elements[i]].corners()) weight[v.index()] += rows.area[i];
    std::vector<float> row(stride);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const VertexId v : mesh[rows.elements[i]].corners()) {
            if (!radiosity.exposed[v.index()] || !(rows.area[i] > 0)) continue;
            const float share = rows.area[i] / weight[v.index()];
            for (std::size_t c = 0; c < stride; ++c) row[c] = share * irradiance[RowId(i)][c];
            radiosity.receive(v, row);
        }
}

std::uint64_t gather_at_vertices(Radiosity& radiosity, const ElementCaster& caster,
                                 const RowField& reflected, float tolerance,
                                 const ColumnOptions& options) {
    const std::size_t count = radiosity.receivers.size(), stride = radiosity.columns.stride;
    std::vector<std::uint32_t> everyone(count);
    std::iota(everyone.begin(), everyone.end(), 0u);
    Received received;
    received.reset(count, stride);
    const std::uint64_t rays = cast_emission(radiosity, Lamps(radiosity), radiosity.receivers,
                                             everyone, tolerance, options, received);
    radiosity.seen = received.seen;
    parallel_for(
        count,
        [&](std::size_t v) {
            if (!radiosity.exposed[v]) return;
            const Vertex& vertex = radiosity.mesh.vertices()[v];
            std::vector<float> row(stride, 0.0f);
            caster.cast_point(vertex.sample, Vec3(vertex.normal), hash_bits(options.seed, 0x7e7, v),
                              [&](std::uint32_t hit, float share) {
                                  const auto R = reflected[RowId(hit)];
                                  for (std::size_t c = 0; c < stride; ++c) row[c] += share * R[c];
                              });
            for (std::size_t c = 0; c < stride; ++c)
                row[c] = received.row(v, stride)[c] + row[c] / static_cast<float>(caster.rays());
            radiosity.receive(VertexId(v), row);
            radiosity.variance[v] += received.variance[v];
        },
        16);
    return rays + std::uint64_t{caster.rays()} * count;
}

}  // namespace exitance
