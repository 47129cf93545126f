// SPDX-License-Identifier: Apache-2.0
// The inner loops of polygon_block.h; included by instruction_sets.h.

constexpr std::size_t lanes = PolygonBlock::capacity;

inline void measure(const Blocker& blocker, const PolygonBlock& block, float slack,
                    BlockHeights& heights) {
    const std::size_t planes = blocker.planes.size();
    heights.corner.resize(planes * 4 * lanes);
    heights.lowest.resize(planes * lanes);
    heights.highest.resize(planes * lanes);
    heights.before = heights.beyond = 0;
    for (std::size_t first = 0; first < lanes; first += EXITANCE_LANES) {
        for (std::size_t f = 0; f < planes; ++f) {
            const Vec3f n(blocker.planes[f].normal);
            const auto offset = static_cast<float>(blocker.planes[f].offset);
            Wide low = wide(1e30f), high = wide(-1e30f);
            for (std::size_t c = 0; c < 4; ++c) {
                const Wide h = load(&block.x[c][first]) * n.x + load(&block.y[c][first]) * n.y +
                               load(&block.z[c][first]) * n.z - offset;
                low = wide_min(low, h);
                high = wide_max(high, h);
                store(&heights.corner[(f * 4 + c) * lanes + first], h);
            }
            store(&heights.lowest[f * lanes + first], low);
            store(&heights.highest[f * lanes + first], high);
        }
        const Wide nx = load(&block.nx[first]), ny = load(&block.ny[first]),
                   nz = load(&block.nz[first]), offset = load(&block.offset[first]);
        Wide low = wide(1e30f), high = wide(-1e30f);
        for (const Vec3& corner : blocker.corners) {
            const Vec3f p(corner);
            const Wide h = nx * p.x + ny * p.y + nz * p.z - offset;
            low = wide_min(low, h);
            high = wide_max(high, h);
        }
        heights.before |= lane_bits(low >= -slack) << first;
        heights.beyond |= lane_bits(high <= slack) << first;
    }
}

inline void stand_between(const Blocker& blocker, const BlockHeights& heights,
                          std::span<const Vec3, 4> corners, float slack, Standing& standing) {
    constexpr std::size_t most = 64;
    const std::size_t planes = blocker.planes.size();
    if (planes > most) {  // too many faces to look at them all for every pair
        standing = {heights.beyond, 0};
        return;
    }
    std::array<std::array<float, 4>, most> h;
    std::array<Side, most> side;
    std::array<bool, most> in_front;
    const std::array<Vec3f, 4> at{Vec3f(corners[0]), Vec3f(corners[1]), Vec3f(corners[2]),
                                  Vec3f(corners[3])};
    for (std::size_t f = 0; f < planes; ++f) {
        const Vec3f n(blocker.planes[f].normal);
        const auto offset = static_cast<float>(blocker.planes[f].offset);
        for (std::size_t c = 0; c < 4; ++c) h[f][c] = dot(n, at[c]) - offset;
        side[f] = side_of(h[f], slack);
        in_front[f] = *std::min_element(h[f].begin(), h[f].end()) >= -slack;
    }
    for (std::size_t first = 0; first < lanes; first += EXITANCE_LANES) {
        WideMask apart{};
        const std::size_t faces = blocker.solid ? planes : 1;
        for (std::size_t f = 0; f < faces; ++f) {
            if (in_front[f]) apart |= load(&heights.lowest[f * lanes + first]) >= -slack;
            if (side[f] == Side::back && !blocker.solid)
                apart |= load(&heights.highest[f * lanes + first]) <= slack;
        }
        if (!any(~apart)) {
            standing.apart |= lane_bits(apart) << first;
            continue;
        }
        WideMask crossed{};
        // What lies in a face is not hidden from what rises above that face.
        for (std::size_t f = 0; f < faces; ++f)
            if (in_front[f] && side[f] == Side::back)
                crossed |= load(&heights.highest[f * lanes + first]) > slack;
        for (const Blocker::Edge& e : blocker.edges) {
            const Side l = side[e.left], r = side[e.right];
            bool flip = l == Side::back;
            if (blocker.solid) {
                if (l == r && l != Side::both) continue;  // never on the outline
                if (l == Side::both || r == Side::both) {
                    crossed = ~WideMask{};
                    continue;
                }
            } else if (l == Side::both) {
                crossed = ~WideMask{};
                continue;
            }
            Wide low = wide(1e30f), high = wide(-1e30f);
            float reach = 0;
            for (std::size_t c = 0; c < 4; ++c)
                reach = std::max(reach, std::max(std::abs(h[e.left][c]), std::abs(h[e.right][c])));
            for (std::size_t y = 0; y < 4; ++y) {
                const Wide yl = load(&heights.corner[(e.left * 4 + y) * lanes + first]);
                const Wide yr = load(&heights.corner[(e.right * 4 + y) * lanes + first]);
                for (std::size_t c = 0; c < 4; ++c) {
                    const Wide value = yr * h[e.left][c] - yl * h[e.right][c];
                    low = wide_min(low, value);
                    high = wide_max(high, value);
                }
            }
            if (flip) {
                const Wide other = -low;
                low = -high;
                high = other;
            }
            const float near = slack * reach;
            apart |= low >= -near;
            crossed |= high > near;
        }
        standing.apart |= lane_bits(apart) << first;
        standing.hides |= lane_bits(~apart & ~crossed) << first;
    }
    standing.apart |= heights.beyond;
    standing.hides &= heights.before & ~standing.apart;
}
