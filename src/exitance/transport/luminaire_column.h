// SPDX-License-Identifier: Apache-2.0
// What receivers get from one luminaire: the column of the light operator that belongs to an
// emitter without geometry.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/transport/column.h"
#include "exitance/transport/luminaire_source.h"

namespace exitance {

/// Computes entries[i] of receiver which[i] (relative to RayCaster::middle()): `factor` is the
/// irradiance without anything in the way for a colour of 1, `visible` its visible share.
/// `tolerance`: irradiance that does not matter, for the number of shadow rays, at most 256 per
/// receiver. `number` decorrelates the samples of different luminaires. `irradiance`, if given, are
/// the factors. Returns rays cast.
std::uint64_t compute_luminaire_column(const RayCaster& caster, const LuminaireSource& source,
                                       double tolerance, std::uint32_t number,
                                       const Receivers& receivers,
                                       std::span<const std::uint32_t> which,
                                       const ColumnOptions& options, std::span<ColumnEntry> entries,
                                       std::span<const float> irradiance = {});

}  // namespace exitance
