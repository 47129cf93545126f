// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/distant_cast.h"

#include <vector>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/transport/distant_column.h"

namespace exitance {

namespace {

// Apart from the numbers of elements, faces and luminaires.
std::uint32_t number_of(std::size_t light) {
    return static_cast<std::uint32_t>(hash_bits(0x5c1ULL, light));
}

}  // namespace

std::uint64_t cast_suns(const Radiosity& radiosity, const Receivers& receivers,
                        std::span<const std::uint32_t> which, float tolerance,
                        const ColumnOptions& options, Received& received) {
    std::uint64_t rays = 0;
    for (std::size_t l = 0; l < radiosity.scene.distant.size(); ++l) {
        const DistantLight& light = radiosity.scene.distant[l];
        if (light.kind != DistantLight::Kind::disc) continue;
        const auto colour = radiosity.emitted_from_afar(l);
        const float level = radiosity.columns.luminance(colour);
        if (!(level > 0)) continue;
        std::vector<ColumnEntry> entries(which.size());
        rays += compute_sun_column(radiosity.caster, light, double(tolerance) / double(level),
                                   number_of(l), receivers, which, options, entries);
        received.add(which, entries, colour, level, level);
    }
    return rays;
}

std::uint64_t cast_skies(const Radiosity& radiosity, const Receivers& receivers,
                         std::span<const std::uint32_t> which, float tolerance,
                         const ColumnOptions& options, Received& received) {
    const std::size_t stride = radiosity.columns.stride, bands = radiosity.columns.bands;
    std::uint64_t rays = 0;
    for (const auto& [l, sky] : radiosity.skies) {
        const std::size_t group = radiosity.groups.group_of_distant[l];
        const auto weight = static_cast<float>(radiosity.groups.groups[group].weight);
        if (!(weight > 0)) continue;
        std::vector<SkyEntry> entries(which.size());
        std::vector<float> light(which.size() * bands);
        rays += compute_sky_column(radiosity.caster, sky, double(tolerance) / double(weight),
                                   number_of(l), receivers, which, options, entries, light);
        parallel_for(
            which.size(),
            [&](std::size_t i) {
                const std::uint32_t r = which[i];
                for (std::size_t b = 0; b < bands; ++b)
                    received.rows[r * stride + group * bands + b] += light[i * bands + b];
                received.light[r] += weight * entries[i].received;
                received.unblocked[r] += weight * entries[i].open;
                received.variance[r] += weight * weight * entries[i].variance;
            },
            1024);
    }
    return rays;
}

}  // namespace exitance
