// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/exposure.h"

#include <limits>

#include "exitance/math/frame.h"
#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"

namespace exitance {

void find_exposed(const RayCaster& caster, std::span<const char> two_sided,
                  const Receivers& receivers, std::size_t first, std::span<char> exposed) {
    const double clearance = caster.clearance();
    parallel_blocks(exposed.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t r = first + i;
            const Vec3 normal(receivers.normal(r));
            const Vec3 origin = Vec3(receivers.point(r)) + normal * clearance;
            const Frame frame(normal);
            RayPacket rays;
            rays.near.fill(0.0f), rays.far.fill(std::numeric_limits<float>::infinity());
            for (std::uint32_t k = 0; k < RayPacket::width; ++k) {
                const Vec3 d = frame.to_world(
                    cosine_hemisphere(low_discrepancy(hash_bits(receivers.key[r], 0xe7u), k)));
                rays.aim(k, origin, d);
            }
            RayCaster::PacketHits hits;
            closest_beyond_glass(caster, rays, hits, [](auto, const auto&) {});
            int backs = 0;
            for (std::size_t k = 0; k < RayPacket::width; ++k)
                if (hits.primitive[k] != 0xffffffffu && !(hits.front >> k & 1u) &&
                    !two_sided[hits.primitive[k]])
                    ++backs;
            exposed[i] = backs <= 8;
        }
    });
}

}  // namespace exitance
