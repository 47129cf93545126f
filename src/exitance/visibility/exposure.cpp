// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/exposure.h"

#include <algorithm>
#include <bit>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"
#include "exitance/visibility/hemisphere_rays.h"

namespace exitance {

namespace {

constexpr std::uint32_t width = RayPacket::width;
// Four rays agree nearly everywhere, on none or all of them; where they do not, sixteen decide.
constexpr std::uint32_t few = 4;

struct Question {
    const RayCaster& caster;
    std::span<const char> two_sided;
    const Receivers& receivers;

    /// Aims `n` lanes from `lane` on at the first directions of receiver `r`.
    void aim(RayPacket& rays, std::size_t r, std::uint32_t lane, std::uint32_t n) const {
        const Vec3f normal = receivers.normal(r);
        const auto clearance = static_cast<float>(caster.clearance());
        RayPacket all;
        aim_hemisphere(all, receivers.point(r) + normal * clearance, normal,
                       hash_bits(receivers.key[r], 0xe7u), 0);
        for (std::uint32_t k = 0; k < n; ++k) {
            rays.origin_x[lane + k] = all.origin_x[k],
                                 rays.direction_x[lane + k] = all.direction_x[k];
            rays.origin_y[lane + k] = all.origin_y[k],
                                 rays.direction_y[lane + k] = all.direction_y[k];
            rays.origin_z[lane + k] = all.origin_z[k],
                                 rays.direction_z[lane + k] = all.direction_z[k];
            rays.near[lane + k] = all.near[k], rays.far[lane + k] = all.far[k];
            rays.active |= 1u << (lane + k);
        }
    }

    /// Bit k: ray k met a back that no light comes from.
    std::uint32_t backs(const RayPacket& rays) const {
        RayCaster::PacketHits hits;
        closest_beyond_glass(caster, rays, hits, [](auto, const auto&) {});
        std::uint32_t out = 0;
        for (std::uint32_t k = 0; k < width; ++k)
            if ((rays.active >> k & 1u) && hits.primitive[k] != 0xffffffffu &&
                !(hits.front >> k & 1u) && !two_sided[hits.primitive[k]])
                out |= 1u << k;
        return out;
    }
};

}  // namespace

void find_exposed(const RayCaster& caster, std::span<const char> two_sided,
                  const Receivers& receivers, std::size_t first, std::span<char> exposed) {
    const Question question{caster, two_sided, receivers};
    constexpr std::size_t together = width / few;
    parallel_blocks(exposed.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i += together) {
            const std::size_t n = std::min(together, end - i);
            RayPacket rays;
            for (std::size_t k = 0; k < n; ++k)
                question.aim(rays, first + i + k, static_cast<std::uint32_t>(k) * few, few);
            const std::uint32_t backs = question.backs(rays);
            for (std::size_t k = 0; k < n; ++k) {
                const std::uint32_t own = backs >> (k * few) & ((1u << few) - 1);
                exposed[i + k] = own == 0;
                if (own == 0 || own == (1u << few) - 1) continue;
                RayPacket all;
                question.aim(all, first + i + k, 0, width);
                exposed[i + k] = std::popcount(question.backs(all)) <= int{width} / 2;
            }
        }
    });
}

}  // namespace exitance
