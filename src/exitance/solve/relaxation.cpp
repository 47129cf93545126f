// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/relaxation.h"

#include <algorithm>

namespace exitance {

void Relaxation::add(std::size_t i, std::span<const float> change) {
    const auto R = reflected_[RowId(i)];
    for (std::size_t c = 0; c < change.size(); ++c) R[c] += change[c];
    const bool any = std::any_of(change.begin(), change.end(), [](float x) { return x != 0; });
    if (any) transport_.shoot(RowId(i), change, irradiance_);
}

double GaussSeidel::sweep() {
    const std::size_t count = std::min(rows_per_step(), system_.rows() - next_);
    std::vector<float> change(system_.columns.stride);
    for (std::size_t k = 0; k < count; ++k, ++next_) {
        residual_of(next_, change);
        add(next_, change);
    }
    if (next_ == system_.rows()) next_ = 0;
    return as_sweeps(count);
}

// Irradiance that all that is unshot would add on average: U / (A (1 − ρ)), per column.
std::vector<float> Southwell::ambient() const {
    const Columns& columns = system_.columns;
    std::vector<double> unshot(columns.stride, 0.0), absorbing(columns.stride, 0.0);
    std::vector<float> row(columns.stride);
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        residual_of(i, row);
        const auto rho = system_.rho[RowId(i)];
        for (std::size_t c = 0; c < columns.count; ++c) {
            unshot[c] += double(system_.area[i] * row[c]);
            absorbing[c] += double(system_.area[i] * (1.0f - rho[c]));
        }
    }
    for (std::size_t c = 0; c < columns.stride; ++c)
        row[c] = absorbing[c] > 0 ? static_cast<float>(unshot[c] / absorbing[c]) : 0.0f;
    return row;
}

double Southwell::sweep() {
    const Columns& columns = system_.columns;
    std::vector<float> change(columns.stride), best(columns.stride);
    std::size_t count = 0;
    for (; count < rows_per_step(); ++count) {
        const std::vector<float> spread =
            options_.overshoot ? ambient() : std::vector<float>(columns.stride, 0.0f);
        std::size_t brightest = 0;
        float most = 0;
        for (std::size_t i = 0; i < system_.rows(); ++i) {
            residual_of(i, change);
            const auto rho = system_.rho[RowId(i)];
            for (std::size_t c = 0; c < columns.stride; ++c) change[c] += rho[c] * spread[c];
            const float moved = system_.area[i] * columns.magnitude(change);
            if (moved > most) most = moved, brightest = i, best = change;
        }
        if (most <= 0) break;
        add(brightest, best);
    }
    return as_sweeps(std::max<std::size_t>(count, 1));
}

}  // namespace exitance
