// SPDX-License-Identifier: Apache-2.0
// What stands in the way of light: every place once, though a two-sided polygon is two facets.
#pragma once

#include <vector>

#include "exitance/formfactor/enclosure.h"
#include "exitance/visibility/ray_caster.h"

namespace exitance {

struct BlockingFacet {
    static constexpr std::uint32_t none = 0xffffffffU;
    std::uint32_t front = none;  ///< facet that is seen from its front
    std::uint32_t back = none;   ///< facet with the same corners that faces the other way
};

/// Facets with the same corners, facing opposite ways, are one blocker.
std::vector<BlockingFacet> blocking_facets(const Enclosure& enclosure);

/// Rays against all facets. Primitive k is blocker k.
class FacetCaster {
  public:
    explicit FacetCaster(const Enclosure& enclosure);

    const RayCaster& rays() const { return rays_; }
    /// The facet whose front a ray has met; BlockingFacet::none for a back.
    std::uint32_t facet(std::uint32_t primitive, bool front) const {
        return front ? blockers_[primitive].front : blockers_[primitive].back;
    }

  private:
    std::vector<BlockingFacet> blockers_;
    RayCaster rays_;
};

}  // namespace exitance
