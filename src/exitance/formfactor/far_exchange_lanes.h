// SPDX-License-Identifier: Apache-2.0
// The inner loop of far_exchange.h; included by instruction_sets.h.

inline void far_exchange(const SampledFacet& facet, const SampledBlock& block, float slack,
                         FarExchange& exchange) {
    const Vec3f n(facet.plane.normal);
    const auto offset = static_cast<float>(facet.plane.offset);
    exchange.faces = exchange.wholly = 0;
    for (std::size_t first = 0; first < PolygonBlock::capacity; first += EXITANCE_LANES) {
        const PolygonBlock& outlines = block.outlines;
        const Wide nx = load(&outlines.nx[first]), ny = load(&outlines.ny[first]),
                   nz = load(&outlines.nz[first]), block_offset = load(&outlines.offset[first]);
        Wide low = wide(1e30f), high = wide(-1e30f), low_of = low, high_of = high;
        for (std::size_t c = 0; c < 4; ++c) {
            const Wide h = load(&outlines.x[c][first]) * n.x + load(&outlines.y[c][first]) * n.y +
                           load(&outlines.z[c][first]) * n.z - offset;
            low = wide_min(low, h);
            high = wide_max(high, h);
            const Vec3f p(facet.corners[c]);
            const Wide of = nx * p.x + ny * p.y + nz * p.z - block_offset;
            low_of = wide_min(low_of, of);
            high_of = wide_max(high_of, of);
        }
        const WideMask faces = (high > slack) & (high_of > slack);
        exchange.faces |= lane_bits(faces) << first;
        exchange.wholly |= lane_bits(faces & (low >= -slack) & (low_of >= -slack)) << first;
        Wide sum = wide(0);
        if (any(faces)) {
            for (std::size_t k = 0; k < 4; ++k) {
                const Vec3f p(facet.points[k]);
                Wide part = wide(0);
                for (std::size_t m = 0; m < 4; ++m) {
                    const Wide dx = load(&block.x[m][first]) - p.x,
                               dy = load(&block.y[m][first]) - p.y,
                               dz = load(&block.z[m][first]) - p.z;
                    const Wide r2 = wide_max(dx * dx + dy * dy + dz * dz, wide(1e-20f));
                    const Wide up = wide_max(dx * n.x + dy * n.y + dz * n.z, wide(0));
                    const Wide down = wide_max(-(dx * nx + dy * ny + dz * nz), wide(0));
                    part += load(&block.weight[m][first]) * (up * down) / (r2 * r2);
                }
                sum += part * static_cast<float>(facet.weights[k]);
            }
        }
        store(&exchange.area[first], sum * (1 / std::numbers::pi_v<float>));
        const Vec3f c(facet.centre);
        const Wide dx = load(&block.cx[first]) - c.x, dy = load(&block.cy[first]) - c.y,
                   dz = load(&block.cz[first]) - c.z;
        const Wide d2 = dx * dx + dy * dy + dz * dz + 1e-30f;
        store(&exchange.distance[first],
              d2 * reciprocal_root(d2) /
                  (load(&block.radius[first]) + static_cast<float>(facet.radius)));
    }
}
