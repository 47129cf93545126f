// SPDX-License-Identifier: Apache-2.0
// The space between two boxes: what is outside of it stands between no two points of them (Haines &
// Wallace 1991, "Shaft culling for efficient ray-traced radiosity").
#pragma once

#include <array>
#include <cstdint>

#include "exitance/math/box.h"

namespace exitance {

class Shaft {
  public:
    Shaft(const Box& a, const Box& b)
        : lower_(min(a.lower, b.lower)), upper_(max(a.upper, b.upper)) {
        // In each projection along an axis the hull of two rectangles has a slanted side in every
        // quadrant where one box reaches further along one axis and the other along the other.
        for (std::size_t u = 0; u < 3; ++u) {
            const std::size_t v = u == 2 ? 0 : u + 1;
            for (const bool high_u : {false, true})
                for (const bool high_v : {false, true}) {
                    const double au = high_u ? a.upper[u] : a.lower[u];
                    const double av = high_v ? a.upper[v] : a.lower[v];
                    const double bu = high_u ? b.upper[u] : b.lower[u];
                    const double bv = high_v ? b.upper[v] : b.lower[v];
                    const double su = high_u ? 1 : -1, sv = high_v ? 1 : -1;
                    if (!((au - bu) * su * (av - bv) * sv < 0)) continue;
                    // Normal of the line through both corners, towards the quadrant.
                    const double nu = su * std::abs(av - bv), nv = sv * std::abs(au - bu);
                    sides_[count_++] = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v),
                                        nu, nv, nu * au + nv * av};
                }
        }
    }

    /// Whether the box has no volume in common with the space between.
    bool misses(const Box& box) const {
        if (box.lower.x >= upper_.x || box.upper.x <= lower_.x || box.lower.y >= upper_.y ||
            box.upper.y <= lower_.y || box.lower.z >= upper_.z || box.upper.z <= lower_.z)
            return !touches_flat(box);
        for (std::size_t k = 0; k < count_; ++k) {
            const Side& s = sides_[k];
            if (s.nu * (s.nu > 0 ? box.lower[s.u] : box.upper[s.u]) +
                    s.nv * (s.nv > 0 ? box.lower[s.v] : box.upper[s.v]) >=
                s.offset)
                return true;
        }
        return false;
    }

  private:
    struct Side {
        std::uint8_t u, v;
        double nu, nv, offset;
    };

    // A flat box, or a flat shaft, has no volume to share: then strictly apart counts.
    bool touches_flat(const Box& box) const {
        for (std::size_t k = 0; k < 3; ++k) {
            const bool flat = box.lower[k] >= box.upper[k] || lower_[k] >= upper_[k];
            if (flat ? box.lower[k] > upper_[k] || box.upper[k] < lower_[k]
                     : box.lower[k] >= upper_[k] || box.upper[k] <= lower_[k])
                return false;
        }
        return true;
    }

    Vec3 lower_, upper_;
    std::array<Side, 12> sides_;
    std::size_t count_ = 0;
};

}  // namespace exitance
