// SPDX-License-Identifier: Apache-2.0
// Which places are open to the room, and which lie under or inside something.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/mesh/ids.h"
#include "exitance/scene/scene.h"
#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// exposed[i] of receivers [first, first + exposed.size()): false if most of sixteen rays over the
/// hemisphere meet the back of a one-sided polygon, which no light can come from: the place is
/// buried in a solid, and its zero irradiance says nothing about the surface beside it.
/// `two_sided`: per primitive of the caster.
void find_exposed(const RayCaster& caster, std::span<const char> two_sided,
                  const Receivers& receivers, std::size_t first, std::span<char> exposed);

/// Whether a place on `polygon` seen along `normal` is that polygon's own. Where several polygons
/// share a plane and face the same way (a doubled wall, a poster drawn on one), each would send the
/// light of all; the first of them in the scene owns the place.
bool owns_place(const RayCaster& caster, const Scene& scene, PolygonId polygon, const Vec3& place,
                const Vec3& normal);

}  // namespace exitance
