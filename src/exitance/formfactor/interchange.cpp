// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/interchange.h"

#include <Eigen/LU>
#include <cmath>

#include "exitance/run/error.h"

namespace exitance {

FormFactorMatrix interchange_factors(const FormFactorMatrix& F,
                                     std::span<const ExchangeSurface> surfaces) {
    const auto n = static_cast<Eigen::Index>(F.rows());
    const ExchangeAreas S = symmetrised(F);
    Eigen::VectorXd A(n), emissivity(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        A[i] = F.areas()[static_cast<std::size_t>(i)];
        emissivity[i] = surfaces[static_cast<std::size_t>(i)].emissivity;
    }
    // Columns of S ε and of A − S ρ at once.
    Eigen::MatrixXd received = Eigen::MatrixXd::Zero(n, n), system = received;
    for (Eigen::Index i = 0; i < n; ++i)
        S.visit_row(static_cast<std::size_t>(i), [&](std::size_t column, float area) {
            const auto j = static_cast<Eigen::Index>(column);
            const double s = static_cast<double>(area);
            received(i, j) = s * emissivity[j];
            received(j, i) = s * emissivity[i];
            system(i, j) = -s * (1 - emissivity[j]);
            system(j, i) = -s * (1 - emissivity[i]);
        });
    system.diagonal() += A;
    const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> factors(system);
    received = factors.solve(received);
    ExchangeAreas total(F.rows());
    std::vector<float> row;
    for (Eigen::Index i = 0; i < n; ++i) {
        row.clear();
        for (Eigen::Index j = 0; j <= i; ++j) {
            const double one = A[i] * emissivity[i] * received(i, j),
                         other = A[j] * emissivity[j] * received(j, i);
            if (!std::isfinite(one + other))
                throw Error(Fault::bad_input,
                            "total interchange factors: every surface reflects everything, "
                            "expected an emissivity above 0 somewhere");
            row.push_back(static_cast<float>(0.5 * (one + other)));
        }
        total.set_row(static_cast<std::size_t>(i), row);
    }
    return {F.areas(), std::move(total)};
}

}  // namespace exitance
