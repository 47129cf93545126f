// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/exchange_areas.h"

#include <algorithm>

namespace exitance {

void ExchangeAreas::set_row(std::size_t i, std::span<const float> areas) {
    const auto kept =
        areas.size() - static_cast<std::size_t>(std::count(areas.begin(), areas.end(), 0.0F));
    if (kept * 2 >= areas.size()) {
        rows_[i] = Dense(areas.begin(), areas.end());
        return;
    }
    Sparse sparse;
    sparse.columns.reserve(kept);
    sparse.areas.reserve(kept);
    for (std::size_t j = 0; j < areas.size(); ++j) {
        if (areas[j] == 0) continue;
        sparse.columns.push_back(static_cast<std::uint32_t>(j));
        sparse.areas.push_back(areas[j]);
    }
    rows_[i] = std::move(sparse);
}

void ExchangeAreas::set_row(std::size_t i, std::vector<std::uint32_t> columns,
                            std::vector<float> areas) {
    if (columns.size() * 2 < i + 1) {
        rows_[i] = Sparse{std::move(columns), std::move(areas)};
        return;
    }
    Dense dense(i + 1);
    for (std::size_t k = 0; k < columns.size(); ++k) dense[columns[k]] = areas[k];
    rows_[i] = std::move(dense);
}

double ExchangeAreas::at(std::size_t i, std::size_t j) const {
    if (j > i) std::swap(i, j);
    if (const auto* dense = std::get_if<Dense>(&rows_[i])) return (*dense)[j];
    const Sparse& sparse = std::get<Sparse>(rows_[i]);
    const auto found = std::lower_bound(sparse.columns.begin(), sparse.columns.end(), j);
    if (found == sparse.columns.end() || *found != j) return 0;
    return sparse.areas[static_cast<std::size_t>(found - sparse.columns.begin())];
}

std::vector<double> ExchangeAreas::times(const std::vector<double>& x) const {
    std::vector<double> y(x.size());
    for (std::size_t i = 0; i < rows(); ++i)
        visit_row(i, [&](std::size_t j, float area) {
            const double s = static_cast<double>(area);
            y[i] += s * x[j];
            if (j != i) y[j] += s * x[i];
        });
    return y;
}

std::size_t ExchangeAreas::bytes() const {
    std::size_t sum = rows_.capacity() * sizeof(rows_[0]);
    for (const auto& row : rows_) {
        if (const auto* dense = std::get_if<Dense>(&row)) {
            sum += dense->capacity() * sizeof(float);
        } else {
            const Sparse& sparse = std::get<Sparse>(row);
            sum += sparse.columns.capacity() * sizeof(std::uint32_t) +
                   sparse.areas.capacity() * sizeof(float);
        }
    }
    return sum;
}

}  // namespace exitance
