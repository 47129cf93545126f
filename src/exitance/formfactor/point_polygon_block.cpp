// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/point_polygon_block.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/math/multiversion.h"

namespace exitance {

namespace {

#define EXITANCE_INLINE [[gnu::always_inline]] inline

// atan(q)/q as a polynomial in q² on [0, 1], weighted minimax fit, error 1.4e-8.
EXITANCE_INLINE float arctangent(float q) {
    const float z = q * q;
    float p = 0.0029035524814f;
    p = p * z - 0.0162830078008f;
    p = p * z + 0.0430393674540f;
    p = p * z - 0.0753367601448f;
    p = p * z + 0.1065467736397f;
    p = p * z - 0.1420713364428f;
    p = p * z + 0.1999305410479f;
    p = p * z - 0.3333309395707f;
    p = p * z + 0.9999999863667f;
    return p * q;
}

// Angle in [0, π] with the given sine (≥ 0) and cosine, both up to a common factor.
EXITANCE_INLINE float angle(float sine, float cosine) {
    const float c = std::abs(cosine);
    const float small = std::min(sine, c), large = std::max(std::max(sine, c), 1e-37f);
    float a = arctangent(small / large);
    a = sine > c ? std::numbers::pi_v<float> / 2 - a : a;
    return cosine < 0.0f ? std::numbers::pi_v<float> - a : a;
}

struct Lane {
    float x, y, z;
};

// θ Γ·n of one edge.
EXITANCE_INLINE float edge_term(Lane a, Lane b, Lane n) {
    const float gx = a.y * b.z - a.z * b.y, gy = a.z * b.x - a.x * b.z, gz = a.x * b.y - a.y * b.x;
    const float sine = std::sqrt(gx * gx + gy * gy + gz * gz);
    const float across = gx * n.x + gy * n.y + gz * n.z;
    const float theta = angle(sine, a.x * b.x + a.y * b.y + a.z * b.z);
    return sine > 1e-30f ? theta * across / sine : 0.0f;
}

EXITANCE_INLINE Lane cut(Lane a, Lane b, float t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
}

constexpr std::size_t width = 16;

// A receiver sees the source only if it stands before its front and one corner is above its
// horizon.
EXITANCE_INLINE float reach(const ReceiverBlock& receivers, const Source& source, float clearance,
                            std::size_t r) {
    const Lane n{receivers.nx[r], receivers.ny[r], receivers.nz[r]};
    const float px = receivers.x[r] + clearance * n.x;
    const float py = receivers.y[r] + clearance * n.y;
    const float pz = receivers.z[r] + clearance * n.z;
    float highest = -1.0f;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3f& c = source.corners[i];
        highest = std::max(highest, (c.x - px) * n.x + (c.y - py) * n.y + (c.z - pz) * n.z);
    }
    const Vec3f &c0 = source.corners[0], &ns = source.normal;
    const float front = (px - c0.x) * ns.x + (py - c0.y) * ns.y + (pz - c0.z) * ns.z;
    return std::min(front, highest);
}

EXITANCE_INLINE float factor_of(const ReceiverBlock& receivers, const Source& source,
                                float clearance, float scale, std::size_t r) {
    const Vec3f &c0 = source.corners[0], &c1 = source.corners[1];
    const Vec3f &c2 = source.corners[2], &c3 = source.corners[3];
    const Lane n{receivers.nx[r], receivers.ny[r], receivers.nz[r]};
    const float px = receivers.x[r] + clearance * n.x;
    const float py = receivers.y[r] + clearance * n.y;
    const float pz = receivers.z[r] + clearance * n.z;
    const Lane v[4]{{(c0.x - px) * scale, (c0.y - py) * scale, (c0.z - pz) * scale},
                    {(c1.x - px) * scale, (c1.y - py) * scale, (c1.z - pz) * scale},
                    {(c2.x - px) * scale, (c2.y - py) * scale, (c2.z - pz) * scale},
                    {(c3.x - px) * scale, (c3.y - py) * scale, (c3.z - pz) * scale}};
    float sum = 0.0f, crossed = 0.0f;
    Lane leaves{0, 0, 0}, enters{0, 0, 0};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
        const Lane a = v[i], b = v[(i + 1) & 3];
        const float ha = a.x * n.x + a.y * n.y + a.z * n.z;
        const float hb = b.x * n.x + b.y * n.y + b.z * n.z;
        const float t = ha / (ha - hb == 0.0f ? 1.0f : ha - hb);
        const Lane at = cut(a, b, t);
        const bool a_below = ha <= 0.0f, b_below = hb <= 0.0f;
        const bool rises = a_below & !b_below, sinks = !a_below & b_below;
        const Lane from{rises ? at.x : a.x, rises ? at.y : a.y, rises ? at.z : a.z};
        const Lane to{sinks ? at.x : b.x, sinks ? at.y : b.y, sinks ? at.z : b.z};
        enters.x = rises ? at.x : enters.x;
        enters.y = rises ? at.y : enters.y;
        enters.z = rises ? at.z : enters.z;
        leaves.x = sinks ? at.x : leaves.x;
        leaves.y = sinks ? at.y : leaves.y;
        leaves.z = sinks ? at.z : leaves.z;
        crossed = (rises | sinks) ? 1.0f : crossed;
        const float term = edge_term(from, to, n);
        sum += (a_below & b_below) ? 0.0f : term;
    }
    sum += crossed * edge_term(leaves, enters, n);
    return std::min(std::max(-sum * (0.5f / std::numbers::pi_v<float>), 0.0f), 1.0f);
}

}  // namespace

EXITANCE_MULTIVERSION
void point_polygon_factors(const ReceiverBlock& receivers, const Source& source, float clearance,
                           float* factors) {
    // Lengths are scaled by the source so that products of four of them stay inside float.
    const float scale = 1.0f / std::sqrt(std::max(source.area, 1e-30f));
    for (std::size_t first = 0; first < receivers.size; first += width) {
        alignas(64) float reaches[width], found[width];
        float farthest = 0.0f;
        // Left to the vectoriser as loops: unrolled they would be scalar.
#pragma GCC unroll 1
        for (std::size_t k = 0; k < width; ++k)
            reaches[k] = reach(receivers, source, clearance, first + k);
#pragma GCC unroll 1
        for (std::size_t k = 0; k < width; ++k) farthest = std::max(farthest, reaches[k]);
        if (farthest <= 0.0f) {
            std::fill_n(factors + first, width, 0.0f);
            continue;
        }
#pragma GCC unroll 1
        for (std::size_t k = 0; k < width; ++k)
            found[k] = factor_of(receivers, source, clearance, scale, first + k);
        for (std::size_t k = 0; k < width; ++k)
            factors[first + k] = reaches[k] > 0.0f ? found[k] : 0.0f;
    }
}

}  // namespace exitance
