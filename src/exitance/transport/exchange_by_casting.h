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

/// The same, and `look(i, ends)` sees the ends of sixteen rays from every place of row i that is
/// open; rows are looked at in parallel. The areas of rows become what is open of them by those
/// places.
using LookAtEnds = std::function<void(std::size_t row, const ElementCaster::Ends& ends)>;
ExchangeAreas cast_exchange_areas(const ElementCaster& caster, ElementRows& rows,
                                  const std::function<bool(std::uint64_t rays)>& go_on,
                                  const LookAtEnds& look, const Mesh& mesh);

}  // namespace exitance
