// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/jacobi.h"

#include <cmath>

namespace exitance {

namespace {

// What the series leaves unfollowed, as a part of what may stay unshot.
constexpr double share_left = 0.25;

}  // namespace

double Jacobi::unshot() const {
    if (!transport_.random()) return ElementSolver::unshot();
    // The mean of m products is wrong by 1 / √m of what one is, and moved by 1 / m of that.
    return products_ < 2 ? 1.0 : std::sqrt(products_) * ElementSolver::unshot();
}

double Jacobi::enough() const {
    return transport_.random() ? enough_noise(reflected_) : negligible();
}

Progress Jacobi::progress() const {
    Progress out = ElementSolver::progress();
    if (transport_.random()) out.residual.reset();  // another one in every product
    return out;
}

// While the series is followed, ρ (D + H) − R is what its last reflection brought.
void Jacobi::sweep_sampled() {
    const bool following =
        products_ == 0 &&
        (sweeps() == 0 ||
         ElementSolver::unshot() > share_left * options_.unshot.value_or(negligible()));
    RowField sent(system_.rows(), system_.columns.count), sample(sent);
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        const auto change = sent[RowId(i)], R = reflected_[RowId(i)];
        residual_of(i, change);
        for (std::size_t c = 0; c < R.size(); ++c) R[c] += change[c];
    }
    transport_.gather(following ? sent : reflected_, sample);
    if (!following) ++products_;
    // The series is the first sample of the mean.
    const float share = following ? 1.0f : 1.0f / static_cast<float>(products_ + 1);
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        const auto H = irradiance_[RowId(i)], sampled = sample[RowId(i)];
        for (std::size_t c = 0; c < H.size(); ++c)
            H[c] += share * (following ? sampled[c] : sampled[c] - H[c]);
    }
}

double Jacobi::sweep() {
    if (transport_.random()) {
        sweep_sampled();
        return 1;
    }
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        const auto rho = system_.rho[RowId(i)], D = system_.direct[RowId(i)];
        const auto R = reflected_[RowId(i)], H = irradiance_[RowId(i)];
        for (std::size_t c = 0; c < R.size(); ++c) R[c] = rho[c] * (D[c] + H[c]);
    }
    transport_.gather(reflected_, irradiance_);
    return 1;
}

}  // namespace exitance
