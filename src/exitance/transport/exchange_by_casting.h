// SPDX-License-Identifier: Apache-2.0
// Exchange areas between elements from rays over their hemispheres.
#pragma once

#include <functional>

#include "exitance/formfactor/exchange_areas.h"
#include "exitance/transport/element_caster.h"

namespace exitance {

/// S_ij from the rays of both rows. A ray of row i says that much of S_ij per A_i / n_i, so that
/// the two counts together weigh as the balance heuristic does (Veach & Guibas 1995); the smaller
/// element of a pair, whose rays are denser, says most. Rows are then scaled, symmetrically, until
/// they sum up to what each row's own rays have met: nothing escapes a closed room.
/// `go_on` is asked between blocks of rows with the rays cast so far; false leaves the rest zero.
ExchangeAreas cast_exchange_areas(const ElementCaster& caster, const ElementRows& rows,
                                  const std::function<bool(std::uint64_t rays)>& go_on);

}  // namespace exitance
