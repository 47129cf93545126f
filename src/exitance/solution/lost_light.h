// SPDX-License-Identifier: Apache-2.0
// Light that no surface of the mesh receives.
#pragma once

#include <array>

#include "exitance/solve/radiosity.h"
#include "exitance/visibility/beyond_glass.h"

namespace exitance {

struct LostLight {
    double escaped = 0;  ///< left the scene
    double behind = 0;   ///< met the black back of a one-sided polygon, or a black lamp
    LostLight& operator+=(const LostLight& o) {
        escaped += o.escaped, behind += o.behind;
        return *this;
    }
};

/// Follows sixteen rays, each with its flux, through glass to where they end, and adds what is
/// lost. Rays of `covered` (a bit mask) start below another polygon, whose back takes nothing that
/// had been sent.
inline void follow(const Radiosity& radiosity, const RayPacket& rays,
                   std::array<double, RayPacket::width> flux, std::uint32_t covered,
                   LostLight& lost) {
    const auto is_black = [&](std::size_t k, const RayCaster::PacketHits& met) {
        if (covered >> k & 1u) return false;
        const bool back = !(met.front >> k & 1u) && !radiosity.two_sided()[met.primitive[k]];
        return back || radiosity.black_lamp()[met.primitive[k]];
    };
    RayCaster::PacketHits hits;
    closest_beyond_glass(radiosity.caster, rays, hits, [&](auto k, const auto& met) {
        const auto share = double(radiosity.caster.transmittance(met.primitive[k]));
        if (is_black(k, met)) lost.behind += flux[k] * (1 - share);
        flux[k] *= share;
    });
    for (std::size_t k = 0; k < RayPacket::width; ++k) {
        if (hits.primitive[k] == 0xffffffffu)
            lost.escaped += flux[k];
        else if (is_black(k, hits))
            lost.behind += flux[k];
    }
}

}  // namespace exitance
