// SPDX-License-Identifier: Apache-2.0
// From one exitance per element to irradiance at the vertices.
#pragma once

#include "exitance/solve/radiosity.h"
#include "exitance/transport/column.h"
#include "exitance/transport/element_caster.h"

namespace exitance {

/// A vertex takes the mean of the elements around it by area: cheap, and light is smeared over an
/// element's width, shadows too. `irradiance`: per row.
void average_at_vertices(Radiosity& radiosity, const ElementRows& rows, const RowField& irradiance);

/// One gathering step: every vertex looks for itself. Lamps by their exact factors and shadow rays,
/// what elements reflect by rays over the hemisphere. `reflected`: per row. Returns rays cast.
std::uint64_t gather_at_vertices(Radiosity& radiosity, const ElementCaster& caster,
                                 const RowField& reflected, float tolerance,
                                 const ColumnOptions& options);

}  // namespace exitance
