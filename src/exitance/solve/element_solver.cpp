// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/element_solver.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/parallel.h"

namespace exitance {

namespace {

// Of the error asked for, how much the light that is never shot may take, as in shooting.cpp.
constexpr double unshot_share = 0.15;
// How much of the error asked for noise may take, on average: some places are four times worse,
// and colours of little luminance more than white.
constexpr double noise_share = 0.15;
// Rows whose values a log shows.
constexpr std::size_t shown_rows = 16;

struct Sums {
    double unshot = 0, square = 0, received = 0;
    Sums& operator+=(const Sums& o) {
        unshot += o.unshot, square += o.square, received += o.received;
        return *this;
    }
};

}  // namespace

ElementSolver::ElementSolver(const ElementSystem& system, Transport& transport,
                             const ElementSolverOptions& options)
    : system_(system),
      transport_(transport),
      options_(options),
      reflected_(system.rows(), system.columns.count),
      irradiance_(system.rows(), system.columns.count) {
    std::vector<double> rho_area(system.columns.count, 0.0);
    for (std::size_t i = 0; i < system.rows(); ++i) {
        open_area_ += double(system.area[i]);
        for (std::size_t c = 0; c < rho_area.size(); ++c)
            rho_area[c] += double(system.area[i] * system.rho[RowId(i)][c]);
    }
    most_reflected_ = *std::max_element(rho_area.begin(), rho_area.end());
    find_residual();
    least_unshot_ = unshot_;
}

bool ElementSolver::step() {
    if (sweeps_ - sweep_of_least_ > patience()) return false;
    sweeps_ += sweep();
    find_residual();
    if (unshot() < least_unshot_) least_unshot_ = unshot(), sweep_of_least_ = sweeps_;
    return true;
}

void ElementSolver::residual_of(std::size_t i, std::span<float> out) const {
    const auto rho = system_.rho[RowId(i)], D = system_.direct[RowId(i)], H = irradiance_[RowId(i)],
               R = reflected_[RowId(i)];
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = rho[c] * (D[c] + H[c]) - R[c];
}

void ElementSolver::find_residual() {
    const Columns& columns = system_.columns;
    const Sums sums = parallel_sum<Sums>(system_.rows(), [&](std::size_t begin, std::size_t end) {
        Sums block;
        std::vector<float> row(columns.stride);
        for (std::size_t i = begin; i < end; ++i) {
            const auto area = double(system_.area[i]);
            residual_of(i, row);
            block.unshot += area * double(columns.magnitude(row));
            for (std::size_t c = 0; c < columns.count; ++c)
                block.square += area * double(columns.weight[c]) * double(row[c]) * double(row[c]);
            block.received += area * double(columns.luminance(system_.direct[RowId(i)]) +
                                            columns.luminance(irradiance_[RowId(i)]));
        }
        return block;
    });
    if (sweeps_ == 0) square_at_start_ = sums.square;
    unshot_ = system_.emitted_flux > 0 ? sums.unshot / system_.emitted_flux : 0.0;
    residual_ = square_at_start_ > 0 ? std::sqrt(sums.square / square_at_start_) : 0.0;
    mean_irradiance_ = open_area_ > 0 ? sums.received / open_area_ : 0.0;
}

double ElementSolver::negligible() const {
    // Unshot flux u adds u / (1-ρ) / A to the irradiance in the end, most in the band that is
    // reflected most.
    if (system_.emitted_flux <= 0) return 0.0;
    return unshot_share * options_.error * mean_irradiance_ * (open_area_ - most_reflected_) /
           system_.emitted_flux;
}

double ElementSolver::flux_of(const RowField& field) const {
    double sum = 0;
    for (std::size_t i = 0; i < system_.rows(); ++i)
        sum += double(system_.area[i] * system_.columns.magnitude(field[RowId(i)]));
    return system_.emitted_flux > 0 ? sum / system_.emitted_flux : 0.0;
}

double ElementSolver::enough_noise(const RowField& reflected) const {
    return std::max(negligible(), noise_share * options_.error * flux_of(reflected));
}

double ElementSolver::enough() const {
    return negligible();
}

RowField ElementSolver::irradiance() const {
    RowField out(system_.rows(), system_.columns.count);
    for (std::size_t i = 0; i < system_.rows(); ++i)
        for (std::size_t c = 0; c < system_.columns.count; ++c)
            out[RowId(i)][c] = system_.direct[RowId(i)][c] + irradiance_[RowId(i)][c];
    return out;
}

Progress ElementSolver::progress() const {
    Progress out;
    out.phase = "solving";
    out.fraction_left = unshot();
    out.shots = transport_.counters().shots;
    out.rays = transport_.counters().rays;
    out.sweeps = sweeps_;
    out.residual = residual_;
    if (system_.rows() <= shown_rows)
        for (std::size_t i = 0; i < system_.rows(); ++i)
            out.exitance.push_back(double(system_.columns.luminance(system_.emitted[RowId(i)])) +
                                   double(system_.columns.luminance(reflected_[RowId(i)])));
    return out;
}

}  // namespace exitance
