// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/dense.h"

#include <algorithm>

#include "exitance/run/parallel.h"

namespace exitance {

namespace {

constexpr std::size_t tile = 64;

// H_i += Σ_j s[j] · B_j over `count` consecutive rows j of a field, `Lanes` columns at a time.
template <std::size_t Lanes>
void add_row(const float* s, std::size_t count, const float* B, std::size_t stride, float* H) {
    for (std::size_t c = 0; c < stride; c += Lanes) {
        std::array<float, Lanes> sum;
        std::copy_n(H + c, Lanes, sum.begin());
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t l = 0; l < Lanes; ++l) sum[l] += s[j] * B[j * stride + c + l];
        std::copy_n(sum.begin(), Lanes, H + c);
    }
}

// The same for the transposed part: H_i += s[i] · B_k for `count` consecutive rows i.
template <std::size_t Lanes>
void add_column(const float* s, std::size_t count, const float* B, std::size_t stride, float* H) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < stride; c += Lanes)
            for (std::size_t l = 0; l < Lanes; ++l) H[i * stride + c + l] += s[i] * B[c + l];
}

}  // namespace

DenseTransport::DenseTransport(ExchangeAreas areas, std::vector<float> area, double accuracy)
    : area_(std::move(area)), accuracy_(accuracy) {
    triangle_.resize(area_.size() * (area_.size() + 1) / 2);
    for (std::size_t i = 0; i < area_.size(); ++i) {
        areas.visit_row(i, [&](std::size_t j, float s) { triangle_[i * (i + 1) / 2 + j] = s; });
        areas.set_row(i, {}, {});
    }
}

void DenseTransport::gather(const RowField& exitance, RowField& irradiance) {
    ++counters_.gathers;
    const std::size_t n = rows(), stride = exitance.stride();
    const float* B = exitance.values().data();
    parallel_blocks(n, tile, [&](std::size_t begin, std::size_t end) {
        float* H = irradiance[RowId(begin)].data();
        std::fill(H, H + (end - begin) * stride, 0.0f);
        const auto with = [&]<std::size_t Lanes>() {
            for (std::size_t j = 0; j < end; j += tile)
                for (std::size_t i = begin; i < end; ++i)
                    if (j <= i)
                        add_row<Lanes>(row(i) + j, std::min(tile, i + 1 - j), B + j * stride,
                                       stride, H + (i - begin) * stride);
            for (std::size_t k = begin + 1; k < n; ++k)
                add_column<Lanes>(row(k) + begin, std::min(end, k) - begin, B + k * stride, stride,
                                  H);
        };
        if (stride == 4)
            with.template operator()<4>();
        else if (stride == 8)
            with.template operator()<8>();
        else
            with.template operator()<16>();
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t c = 0; c < stride; ++c)
                H[(i - begin) * stride + c] *= area_[i] > 0 ? 1.0f / area_[i] : 0.0f;
    });
}

void DenseTransport::shoot(RowId from, std::span<const float> exitance, RowField& irradiance) {
    ++counters_.shots;
    const std::size_t j = from.index(), stride = exitance.size();
    parallel_for(
        rows(),
        [&](std::size_t i) {
            const float s = i <= j ? row(j)[i] : row(i)[j];
            if (!(s > 0) || !(area_[i] > 0)) return;
            const float factor = s / area_[i];
            float* H = irradiance[RowId(i)].data();
            for (std::size_t c = 0; c < stride; ++c) H[c] += factor * exitance[c];
        },
        2048);
}

}  // namespace exitance
