// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/relaxation.h"

#include <algorithm>

#include "exitance/run/parallel.h"

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

Southwell::Southwell(const ElementSystem& system, Transport& transport,
                     const ElementSolverOptions& options)
    : Relaxation(system, transport, options),
      absorbing_(system.columns.stride, 0.0),
      spread_(system.columns.stride, 0.0f) {
    for (std::size_t i = 0; i < system.rows(); ++i)
        for (std::size_t c = 0; c < system.columns.count; ++c)
            absorbing_[c] += double(system.area[i] * (1.0f - system.rho[RowId(i)][c]));
    if (options.overshoot) spread_ = ambient(brightest(spread_).unshot);
}

std::vector<float> Southwell::ambient(std::span<const double> unshot) const {
    std::vector<float> row(system_.columns.stride, 0.0f);
    for (std::size_t c = 0; c < system_.columns.count; ++c)
        if (absorbing_[c] > 0) row[c] = static_cast<float>(unshot[c] / absorbing_[c]);
    return row;
}

Southwell::Brightest& Southwell::Brightest::operator+=(const Brightest& other) {
    if (other.moved > moved) moved = other.moved, row = other.row;
    unshot.resize(other.unshot.size(), 0.0);
    for (std::size_t c = 0; c < unshot.size(); ++c) unshot[c] += other.unshot[c];
    return *this;
}

Southwell::Brightest Southwell::brightest(std::span<const float> spread) const {
    const Columns& columns = system_.columns;
    return parallel_sum<Brightest>(system_.rows(), [&](std::size_t begin, std::size_t end) {
        Brightest block{0, 0.0f, std::vector<double>(columns.stride, 0.0)};
        std::vector<float> change(columns.stride), sent(columns.stride);
        for (std::size_t i = begin; i < end; ++i) {
            residual_of(i, change);
            const auto rho = system_.rho[RowId(i)];
            for (std::size_t c = 0; c < columns.stride; ++c) {
                block.unshot[c] += double(system_.area[i] * change[c]);
                sent[c] = change[c] + rho[c] * spread[c];
            }
            const float moved = system_.area[i] * columns.magnitude(sent);
            if (moved > block.moved) block.moved = moved, block.row = i;
        }
        return block;
    });
}

double Southwell::sweep() {
    std::vector<float> change(system_.columns.stride);
    std::size_t count = 0;
    for (; count < rows_per_step(); ++count) {
        const Brightest next = brightest(spread_);
        if (next.moved <= 0) break;
        residual_of(next.row, change);
        const auto rho = system_.rho[RowId(next.row)];
        for (std::size_t c = 0; c < change.size(); ++c) change[c] += rho[c] * spread_[c];
        add(next.row, change);
        if (options_.overshoot) spread_ = ambient(next.unshot);
    }
    return as_sweeps(std::max<std::size_t>(count, 1));
}

}  // namespace exitance
