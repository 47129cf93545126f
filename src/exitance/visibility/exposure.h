// SPDX-License-Identifier: Apache-2.0
// Which places are open to the room, and which lie under or inside something.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// exposed[i] of receivers [first, first + exposed.size()): false if most of sixteen rays over the
/// hemisphere meet the back of a one-sided polygon, which no light can come from: the place is
/// buried in a solid, and its zero irradiance says nothing about the surface beside it. Where the
/// first four rays agree they decide.
/// `two_sided`: per primitive of the caster.
void find_exposed(const RayCaster& caster, std::span<const char> two_sided,
                  const Receivers& receivers, std::size_t first, std::span<char> exposed);

}  // namespace exitance
