// SPDX-License-Identifier: Apache-2.0
// Rays spread over a hemisphere in proportion to the cosine, sixteen at a time.
#pragma once

#include <cstdint>

#include "exitance/visibility/ray_caster.h"

namespace exitance {

/// Aims all sixteen rays of a packet from `origin` [relative to RayCaster::middle()] at directions
/// 16 `packet` … of the sequence `key`, about a unit normal; near and far are set to all there is.
/// The sequence is Sobol's with a random digital shift (Owen's scrambling costs more than a ray of
/// a small scene): every power of two of packets is stratified. Directions have unit length but for
/// 4 · 10⁻⁶.
void aim_hemisphere(RayPacket& rays, const Vec3f& origin, const Vec3f& normal, std::uint64_t key,
                    std::uint32_t packet);

}  // namespace exitance
