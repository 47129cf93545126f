// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/on_the_fly.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/run/parallel.h"

namespace exitance {

OnTheFlyTransport::OnTheFlyTransport(const ElementScene& scene, const ElementRows& rows,
                                     const RowPoints& points, const ElementCaster& caster,
                                     OnTheFlyOptions options, double accuracy)
    : scene_(scene),
      rows_(rows),
      points_(points),
      caster_(caster),
      options_(std::move(options)),
      accuracy_(accuracy),
      everyone_(points.receivers.size()),
      entries_(points.receivers.size()) {
    std::iota(everyone_.begin(), everyone_.end(), 0u);
}

void OnTheFlyTransport::gather(const RowField& exitance, RowField& irradiance) {
    ++counters_.gathers;
    const std::size_t stride = exitance.stride();
    parallel_for(
        rows(),
        [&](std::size_t i) {
            const auto H = irradiance[RowId(i)];
            std::fill(H.begin(), H.end(), 0.0f);
            if (!(rows_.area[i] > 0)) return;
            const std::uint32_t cast = caster_.cast_row(i, [&](std::uint32_t row, float share) {
                const float* B = exitance[RowId(row)].data();
                for (std::size_t c = 0; c < stride; ++c) H[c] += share * B[c];
            });
            for (std::size_t c = 0; cast > 0 && c < stride; ++c) H[c] /= static_cast<float>(cast);
        },
        8);
    counters_.rays += std::uint64_t{caster_.rays()} * rows();
}

void OnTheFlyTransport::shoot(RowId from, std::span<const float> exitance, RowField& irradiance) {
    ++counters_.shots;
    const ElementId id = rows_.elements[from.index()];
    const Face& face = scene_.face(id);
    Source source(scene_.mesh.corners(scene_.mesh[id]), scene_.mesh[id].count,
                  scene_.caster.middle());
    source.covers = scene_.owners.covers(face.polygon, face.back);
    float magnitude = 0;
    for (std::size_t c = 0; c < exitance.size(); ++c)
        magnitude += options_.weight[c] * std::abs(exitance[c]);
    counters_.rays +=
        compute_column(scene_.caster, source, magnitude / options_.tolerance, id.value,
                       points_.receivers, everyone_, options_.column, entries_);
    parallel_for(rows(), [&](std::size_t i) {
        float factor = 0;
        for (std::uint32_t k = points_.begin[i]; k < points_.begin[i + 1]; ++k)
            factor += points_.weight[k] * entries_[k].received();
        const auto H = irradiance[RowId(i)];
        for (std::size_t c = 0; c < exitance.size(); ++c) H[c] += factor * exitance[c];
    });
}

}  // namespace exitance
