// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/jacobi.h"

namespace exitance {

double Jacobi::sweep() {
    for (std::size_t i = 0; i < system_.rows(); ++i) {
        const auto rho = system_.rho[RowId(i)], D = system_.direct[RowId(i)];
        const auto R = reflected_[RowId(i)], H = irradiance_[RowId(i)];
        for (std::size_t c = 0; c < R.size(); ++c) R[c] = rho[c] * (D[c] + H[c]);
    }
    transport_.gather(reflected_, irradiance_);
    return 1;
}

}  // namespace exitance
