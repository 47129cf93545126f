// SPDX-License-Identifier: Apache-2.0
// Where several polygons share a plane and face the same way (a doubled wall, a poster that lies on
// one), each would send the light of all. The first of them in the scene that emits owns the place,
// or the first if none does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/ids.h"
#include "exitance/scene/scene.h"
#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

class PlaceOwners {
  public:
    /// `caster` holds the scene's polygons in their order.
    PlaceOwners(const Scene& scene, const RayCaster& caster);

    /// The owners that cover parts of a side of `polygon`; empty for nearly all polygons.
    std::span<const Cover> covers(PolygonId polygon, bool back) const;

    /// Whether `place` [relative to RayCaster::middle()] on that side is the polygon's own.
    bool owns(PolygonId polygon, bool back, const Vec3& place) const;

    /// Whether something that emits owns that place, and the polygon does not emit.
    bool below_lamp(PolygonId polygon, bool back, const Vec3& place) const;

  private:
    std::vector<std::uint32_t> begin_;  ///< per side: polygon · 2 + back
    std::vector<Cover> covers_;
    std::vector<std::uint32_t> lamps_;  ///< per side: of the owners of what does not emit, the
                                        ///< first so many
};

}  // namespace exitance
