// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/krylov.h"

#include <cmath>

#include "exitance/math/linear_operator.h"

namespace exitance {

namespace {

// Products between two looks at the residual. A restart forgets the directions gone so far; with
// five, a room of reflectance 0.9 needs a product or two more than without restarts.
constexpr int products_per_step = 5;

using Unknowns = Eigen::Map<Eigen::VectorXd>;

template <class Method>
void improve(Method& method, const LinearOperator& matrix, int iterations,
             const std::vector<double>& right, std::vector<double>& y) {
    const Eigen::Map<const Eigen::VectorXd> b(right.data(),
                                              static_cast<Eigen::Index>(right.size()));
    Unknowns guess(y.data(), static_cast<Eigen::Index>(y.size()));
    method.setTolerance(1e-12);  // the loop outside stops it
    method.setMaxIterations(iterations);
    method.compute(matrix);
    const Eigen::VectorXd better = method.solveWithGuess(b, guess);
    if (better.allFinite()) guess = better;  // a breakdown of BiCGSTAB: go on from where it was
}

}  // namespace

Krylov::Krylov(const ElementSystem& system, Transport& transport,
               const ElementSolverOptions& options)
    : ElementSolver(system, transport, options) {
    for (std::size_t i = 0; i < system.rows(); ++i)
        for (std::size_t c = 0; c < system.columns.count; ++c) {
            const auto A = double(system.area[i]), rho = double(system.rho[RowId(i)][c]);
            root_in_.push_back(A > 0 ? std::sqrt(rho / A) : 0.0);
            root_out_.push_back(std::sqrt(rho * A));
            right_.push_back(root_out_.back() * double(system.direct[RowId(i)][c]));
        }
    y_.assign(right_.size(), 0.0);
}

void Krylov::multiply(std::span<double> y) {
    const std::size_t rows = system_.rows(), columns = system_.columns.count;
    RowField R(rows, columns), H(rows, columns);
    const auto each = [&](const auto& visit) {
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t c = 0; c < columns; ++c) visit(RowId(i), c, i * columns + c);
    };
    each([&](RowId i, std::size_t c, std::size_t k) {
        R[i][c] = static_cast<float>(root_in_[k] * y[k]);
    });
    transport_.gather(R, H);
    each([&](RowId i, std::size_t c, std::size_t k) { y[k] -= root_out_[k] * double(H[i][c]); });
}

double Krylov::sweep() {
    const std::size_t columns = system_.columns.count;
    const std::uint64_t before = transport_.counters().gathers;
    const LinearOperator matrix(static_cast<Eigen::Index>(root_in_.size()),
                                [this](Eigen::VectorXd y) {
                                    multiply({y.data(), root_in_.size()});
                                    return y;
                                });
    if (transport_.symmetric()) {
        Eigen::ConjugateGradient<LinearOperator, Eigen::Lower | Eigen::Upper,
                                 Eigen::IdentityPreconditioner>
            method;
        improve(method, matrix, products_per_step, right_, y_);
    } else {
        Eigen::BiCGSTAB<LinearOperator, Eigen::IdentityPreconditioner> method;
        improve(method, matrix, products_per_step / 2, right_, y_);
    }
    for (std::size_t i = 0; i < system_.rows(); ++i)
        for (std::size_t c = 0; c < columns; ++c)
            reflected_[RowId(i)][c] =
                static_cast<float>(root_in_[i * columns + c] * y_[i * columns + c]);
    transport_.gather(reflected_, irradiance_);
    return static_cast<double>(transport_.counters().gathers - before);
}

}  // namespace exitance
