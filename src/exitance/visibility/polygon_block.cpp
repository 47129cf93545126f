// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/polygon_block.h"

#include <algorithm>

namespace exitance {

namespace {

// Whether a plane has the one polygon on its front, on its back, or on both sides.
enum class Side : std::uint8_t { front, back, both };

Side side_of(const std::array<float, 4>& h, float slack) {
    const float low = std::min(std::min(h[0], h[1]), std::min(h[2], h[3]));
    const float high = std::max(std::max(h[0], h[1]), std::max(h[2], h[3]));
    return high <= slack ? Side::back : low >= -slack ? Side::front : Side::both;
}

}  // namespace

}  // namespace exitance

#define EXITANCE_LANES_SOURCE "exitance/visibility/polygon_block_lanes.h"
#include "exitance/math/instruction_sets.h"

namespace exitance {

void PolygonBlock::set(std::size_t lane, std::span<const Vec3> corners, const Plane& plane) {
    for (std::size_t c = 0; c < 4; ++c) {
        const Vec3f p(corners[std::min(c, corners.size() - 1)]);
        x[c][lane] = p.x;
        y[c][lane] = p.y;
        z[c][lane] = p.z;
    }
    nx[lane] = static_cast<float>(plane.normal.x);
    ny[lane] = static_cast<float>(plane.normal.y);
    nz[lane] = static_cast<float>(plane.normal.z);
    offset[lane] = static_cast<float>(plane.offset);
}

void measure(const Blocker& blocker, const PolygonBlock& block, float slack,
             BlockHeights& heights) {
    EXITANCE_LANES_CALL(measure)(blocker, block, slack, heights);
}

Standing stand_between(const Blocker& blocker, const BlockHeights& heights,
                       std::span<const Vec3, 4> corners, float slack) {
    Standing standing;
    EXITANCE_LANES_CALL(stand_between)(blocker, heights, corners, slack, standing);
    return standing;
}

Stand find_rims(const Blocker& blocker, std::span<const Vec3> from, std::span<const Vec3> to,
                double slack, std::vector<std::uint32_t>& rims) {
    constexpr std::size_t most = SmallPolygon::capacity;
    struct Heights {
        std::array<double, most> from, to;
        Side side;
    };
    std::vector<Heights> h(blocker.planes.size());
    for (std::size_t f = 0; f < h.size(); ++f) {
        double low = 1e300, high = -1e300, low_to = 1e300, high_to = -1e300;
        for (std::size_t i = 0; i < from.size(); ++i) {
            h[f].from[i] = blocker.planes[f].height(from[i]);
            low = std::min(low, h[f].from[i]);
            high = std::max(high, h[f].from[i]);
        }
        for (std::size_t i = 0; i < to.size(); ++i) {
            h[f].to[i] = blocker.planes[f].height(to[i]);
            low_to = std::min(low_to, h[f].to[i]);
            high_to = std::max(high_to, h[f].to[i]);
        }
        h[f].side = high <= slack ? Side::back : low >= -slack ? Side::front : Side::both;
        if (blocker.solid || f == 0) {
            if (low >= -slack && low_to >= -slack) return Stand::apart;
            if (!blocker.solid && h[f].side == Side::back && high_to <= slack) return Stand::apart;
        }
    }
    rims.clear();
    for (std::uint32_t k = 0; k < blocker.edges.size(); ++k) {
        const Blocker::Edge& e = blocker.edges[k];
        const Heights &l = h[e.left], &r = h[e.right];
        if (blocker.solid && l.side == r.side && l.side != Side::both) continue;
        if (l.side == Side::both || (blocker.solid && r.side == Side::both)) {
            rims.push_back(k);
            continue;
        }
        const double sign = l.side == Side::back ? -1 : 1;
        double low = 1e300, high = -1e300;
        for (std::size_t i = 0; i < from.size(); ++i)
            for (std::size_t j = 0; j < to.size(); ++j) {
                const double value = sign * (l.from[i] * r.to[j] - r.from[i] * l.to[j]);
                low = std::min(low, value);
                high = std::max(high, value);
            }
        const double near = slack * slack;
        if (low >= -near) return Stand::apart;
        if (high > near) rims.push_back(k);
    }
    return rims.empty() ? Stand::hides : Stand::between;
}

}  // namespace exitance
