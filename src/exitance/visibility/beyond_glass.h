// SPDX-License-Identifier: Apache-2.0
// What rays meet behind the glass on their way.
#pragma once

#include <cstdint>

#include "exitance/visibility/ray_caster.h"

namespace exitance {

/// caster.closest(), and on through glass: `hits` is what each ray meets that is no glass. Before
/// it goes on, `crossing(lane, hit)` is called for every pane on its way, nearest first, with the
/// hits of that step. After 64 panes a ray ends on the next.
template <class Crossing>
void closest_beyond_glass(const RayCaster& caster, const RayPacket& rays,
                          RayCaster::PacketHits& hits, const Crossing& crossing) {
    caster.closest(rays, hits);
    if (!caster.has_glass()) return;
    constexpr int most_panes = 64;
    RayPacket on = rays;
    RayCaster::PacketHits met = hits;
    for (int pane = 0; pane < most_panes; ++pane) {
        std::uint32_t crossed = 0;
        for (std::uint32_t i = 0; i < RayPacket::width; ++i) {
            if (!(on.active >> i & 1u) || met.primitive[i] == 0xffffffffu) continue;
            if (!(caster.transmittance(met.primitive[i]) > 0)) continue;
            crossing(i, met);
            crossed |= 1u << i;
            on.near[i] = met.distance[i] + static_cast<float>(caster.clearance());
        }
        if (crossed == 0) return;
        on.active = crossed;
        caster.closest(on, met);
        for (std::uint32_t i = 0; i < RayPacket::width; ++i) {
            if (!(crossed >> i & 1u)) continue;
            hits.primitive[i] = met.primitive[i];
            hits.distance[i] = met.distance[i];
            hits.u[i] = met.u[i], hits.v[i] = met.v[i];
            hits.front = (hits.front & ~(1u << i)) | (met.front & 1u << i);
        }
    }
}

}  // namespace exitance
