// SPDX-License-Identifier: Apache-2.0
// From a source to receivers: one shot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/solve/light_source.h"
#include "exitance/transport/column.h"

namespace exitance {

/// What receivers got, one entry or row each.
struct Received {
    std::vector<float> rows;       ///< irradiance per column: receivers × stride
    std::vector<float> light;      ///< its luminance
    std::vector<float> unblocked;  ///< the luminance there would be without occlusion
    std::vector<float> seen;       ///< visible share of the lamps' light, see note_seen

    std::vector<float> variance;  ///< of `light`, from sampling visibility

    void reset(std::size_t count, std::size_t stride);
    /// seen = light / unblocked as they stand now, 1 where there is no light.
    void note_seen();
    std::span<const float> row(std::size_t i, std::size_t stride) const {
        return {&rows[i * stride], stride};
    }
    /// Adds what receiver which[i] gets by entries[i] from a source of exitance `row`, whose
    /// luminance is `level`; noise counts by its `magnitude`.
    void add(std::span<const std::uint32_t> which, std::span<const ColumnEntry> entries,
             std::span<const float> row, float level, float magnitude);
};

/// Whether `source` fills so much of a receiver's view that it had better be divided: samples
/// spread over its area would say little of the part right before the receiver, which weighs most.
bool fills_view(const Source& source, const Receivers& receivers, std::uint32_t receiver);

/// Adds the light of `source` to `received`. `which` lists receivers; entry i of `received` belongs
/// to receiver i. `tolerance`: luminance of irradiance that does not matter. Returns rays cast.
std::uint64_t cast_light(const RayCaster& caster, const LightSource& source,
                         const Receivers& receivers, std::span<const std::uint32_t> which,
                         float tolerance, const ColumnOptions& options, std::size_t stride,
                         Received& received);

}  // namespace exitance
