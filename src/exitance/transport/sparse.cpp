// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/sparse.h"

#include <algorithm>

#include "exitance/run/parallel.h"

namespace exitance {

SparseTransport::SparseTransport(ExchangeAreas areas, std::vector<float> area, double accuracy)
    : area_(std::move(area)), accuracy_(accuracy) {
    const std::size_t n = area_.size();
    begin_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        areas.visit_row(i, [&](std::size_t j, float s) {
            if (s == 0) return;
            ++begin_[i + 1];
            if (j != i) ++begin_[j + 1];
        });
    for (std::size_t i = 0; i < n; ++i) begin_[i + 1] += begin_[i];
    column_.resize(begin_[n]), exchange_.resize(begin_[n]);
    // Rows in ascending order fill each row's entries in ascending order: first those of earlier
    // rows from its own half, then those of later rows as they come.
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    const auto put = [&](std::size_t i, std::size_t j, float s) {
        column_[next[i]] = static_cast<std::uint32_t>(j);
        exchange_[next[i]++] = s;
    };
    for (std::size_t i = 0; i < n; ++i)
        areas.visit_row(i, [&](std::size_t j, float s) {
            if (s == 0) return;
            put(i, j, s);
            if (j != i) put(j, i, s);
        });
}

void SparseTransport::gather(const RowField& exitance, RowField& irradiance) {
    ++counters_.gathers;
    const std::size_t stride = exitance.stride();
    parallel_for(
        rows(),
        [&](std::size_t i) {
            const auto H = irradiance[RowId(i)];
            std::fill(H.begin(), H.end(), 0.0f);
            if (!(area_[i] > 0)) return;
            for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
                const float* B = exitance[RowId(column_[k])].data();
                for (std::size_t c = 0; c < stride; ++c) H[c] += exchange_[k] * B[c];
            }
            for (std::size_t c = 0; c < stride; ++c) H[c] /= area_[i];
        },
        64);
}

void SparseTransport::shoot(RowId from, std::span<const float> exitance, RowField& irradiance) {
    ++counters_.shots;
    const std::size_t j = from.index();
    parallel_for(
        begin_[j + 1] - begin_[j],
        [&](std::size_t at) {
            const std::size_t k = begin_[j] + at, i = column_[k];
            if (!(area_[i] > 0)) return;
            const float factor = exchange_[k] / area_[i];
            const auto H = irradiance[RowId(i)];
            for (std::size_t c = 0; c < exitance.size(); ++c) H[c] += factor * exitance[c];
        },
        2048);
}

}  // namespace exitance
