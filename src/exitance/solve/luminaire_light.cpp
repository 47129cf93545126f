// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/luminaire_light.h"

#include <vector>

#include "exitance/run/random.h"
#include "exitance/transport/luminaire_column.h"

namespace exitance {

namespace {

constexpr std::uint64_t luminaire_numbers = 0x1abULL;  // apart from those of elements and faces

}  // namespace

std::uint64_t cast_luminaires(const Radiosity& radiosity, const Receivers& receivers,
                              std::span<const std::uint32_t> which, float tolerance,
                              const ColumnOptions& options, Received& received) {
    std::vector<ColumnEntry> entries(which.size());
    std::uint64_t rays = 0;
    for (std::size_t l = 0; l < radiosity.luminaires.size(); ++l) {
        const auto colour = radiosity.emitted_by_luminaire(l);
        const float level = radiosity.columns.luminance(colour);
        if (!(level > 0)) continue;
        const auto number = static_cast<std::uint32_t>(hash_bits(luminaire_numbers, l));
        rays += compute_luminaire_column(radiosity.caster, radiosity.luminaires[l],
                                         double(tolerance) / double(level), number, receivers,
                                         which, options, entries);
        received.add(which, entries, colour, level, level);
    }
    return rays;
}

}  // namespace exitance
