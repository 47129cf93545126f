// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/stochastic.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/random.h"

namespace exitance {

namespace {

// Rows in a sample: an eighth of them, but enough for small systems to be exact.
constexpr std::size_t sample_share = 8, least_sample = 64;
// What a series leaves unfollowed, as a part of what may stay unshot: every series leaves it.
constexpr double share_left = 0.25;

void add(RowField& sum, const RowField& term, float factor) {
    for (std::size_t i = 0; i < sum.rows(); ++i)
        for (std::size_t c = 0; c < sum.stride(); ++c)
            sum[RowId(i)][c] += factor * term[RowId(i)][c];
}

}  // namespace

StochasticJacobi::StochasticJacobi(const ElementSystem& system, Transport& transport,
                                   const ElementSolverOptions& options)
    : ElementSolver(system, transport, options), squares_(system.rows(), 0.0) {
    for (RowField* field : {&change_, &series_, &arrived_, &mean_, &mean_arrived_})
        *field = RowField(system.rows(), system.columns.count);
    left_ = all_ = ElementSolver::unshot();
}

double StochasticJacobi::unshot() const {
    if (exact_) return left_;
    return complete_ < 2 ? all_ : noise_;
}

Progress StochasticJacobi::progress() const {
    Progress out = ElementSolver::progress();
    out.residual.reset();  // to know it would take a product with the whole matrix
    return out;
}

double StochasticJacobi::enough() const {
    if (exact_) return negligible();
    return enough_noise(mean_);
}

// Systematic sampling with inclusion probabilities π_i = min(1, m Φ_i / Φ): rows in their order,
// which lie side by side in the scene, are represented evenly.
bool StochasticJacobi::shoot_sampled(RowField& arriving) {
    const std::size_t n = system_.rows();
    const std::size_t m = std::max(n / sample_share, least_sample);
    std::vector<double> flux(n);
    double total = 0;
    for (std::size_t i = 0; i < n; ++i)
        total += flux[i] = double(system_.area[i] * system_.columns.magnitude(change_[RowId(i)]));
    const double offset = uniform(hash_bits(options_.seed, complete_), reflections_);
    std::vector<float> row(system_.columns.stride);
    double passed = 0;
    bool all = true;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(flux[i] > 0)) continue;
        const double share = std::min(1.0, static_cast<double>(m) * flux[i] / total);
        const double before = passed;
        passed += share;
        all = all && share == 1.0;
        if (share < 1.0 && std::floor(passed + offset) == std::floor(before + offset)) continue;
        for (std::size_t c = 0; c < row.size(); ++c)
            row[c] = change_[RowId(i)][c] / static_cast<float>(share);
        transport_.shoot(RowId(i), row, arriving);
    }
    return all;
}

bool StochasticJacobi::reflect_sampled() {
    RowField arriving(system_.rows(), system_.columns.count);
    bool all = false;
    if (transport_.random())
        transport_.gather(change_, arriving);
    else
        all = shoot_sampled(arriving);
    add(arrived_, arriving, 1.0f);
    for (std::size_t i = 0; i < system_.rows(); ++i)
        for (std::size_t c = 0; c < system_.columns.stride; ++c)
            change_[RowId(i)][c] = system_.rho[RowId(i)][c] * arriving[RowId(i)][c];
    return all;
}

double StochasticJacobi::sweep() {
    if (reflections_ == 0)
        for (std::size_t i = 0; i < system_.rows(); ++i)
            for (std::size_t c = 0; c < system_.columns.count; ++c)
                change_[RowId(i)][c] = system_.rho[RowId(i)][c] * system_.direct[RowId(i)][c];
    add(series_, change_, 1.0f);
    if (!reflect_sampled()) exact_ = false;
    ++reflections_;
    left_ = flux_of(change_);
    if (complete_ == 0) reflected_ = series_, irradiance_ = arrived_;
    if (left_ <= share_left * options_.unshot.value_or(negligible())) finish_series();
    return 1;
}

void StochasticJacobi::finish_series() {
    ++complete_;
    const auto part = 1.0f / static_cast<float>(complete_);
    double noise = 0;
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        const double before = double(system_.columns.luminance(mean_[RowId(i)]));
        const double here = double(system_.columns.luminance(series_[RowId(i)]));
        for (std::size_t c = 0; c < system_.columns.stride; ++c) {
            mean_[RowId(i)][c] += part * (series_[RowId(i)][c] - mean_[RowId(i)][c]);
            mean_arrived_[RowId(i)][c] +=
                part * (arrived_[RowId(i)][c] - mean_arrived_[RowId(i)][c]);
        }
        const double after = double(system_.columns.luminance(mean_[RowId(i)]));
        squares_[i] += (here - before) * (here - after);
        if (complete_ > 1)
            noise += double(system_.area[i]) *
                     std::sqrt(squares_[i] / double(complete_) / double(complete_ - 1));
    }
    noise_ = system_.emitted_flux > 0 ? noise / system_.emitted_flux : 0.0;
    reflected_ = mean_, irradiance_ = mean_arrived_;
    for (RowField* field : {&series_, &arrived_})
        *field = RowField(system_.rows(), system_.columns.count);
    reflections_ = 0;
}

}  // namespace exitance
