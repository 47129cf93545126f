// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/krylov.h"

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <cmath>

namespace exitance {

/// I − √(ρ A) F √(ρ/A), known by its products alone.
struct ScaledOperator;

}  // namespace exitance

namespace Eigen::internal {

template <>
struct traits<exitance::ScaledOperator> : traits<SparseMatrix<double>> {};

}  // namespace Eigen::internal

namespace exitance {

struct ScaledOperator : Eigen::EigenBase<ScaledOperator> {
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum {
        ColsAtCompileTime = Eigen::Dynamic,
        MaxColsAtCompileTime = Eigen::Dynamic,
        IsRowMajor = false
    };

    Transport& transport;
    std::size_t row_count, columns;
    const std::vector<double>&root_in, &root_out;

    ScaledOperator(Transport& the_transport, std::size_t rows_of_system, std::size_t column_count,
                   const std::vector<double>& in, const std::vector<double>& out)
        : transport(the_transport),
          row_count(rows_of_system),
          columns(column_count),
          root_in(in),
          root_out(out) {}

    Eigen::Index rows() const { return static_cast<Eigen::Index>(root_in.size()); }
    Eigen::Index cols() const { return rows(); }

    template <class Right>
    Eigen::Product<ScaledOperator, Right, Eigen::AliasFreeProduct> operator*(
        const Eigen::MatrixBase<Right>& right) const {
        return {*this, right.derived()};
    }

    template <class Vector>
    Eigen::VectorXd apply(const Vector& y) const {
        RowField R(row_count, columns), H(row_count, columns);
        const auto each = [&](const auto& visit) {
            for (std::size_t i = 0; i < row_count; ++i)
                for (std::size_t c = 0; c < columns; ++c) visit(RowId(i), c, i * columns + c);
        };
        Eigen::VectorXd out = y;
        each([&](RowId i, std::size_t c, std::size_t k) {
            R[i][c] = static_cast<float>(root_in[k] * out[static_cast<Eigen::Index>(k)]);
        });
        transport.gather(R, H);
        each([&](RowId i, std::size_t c, std::size_t k) {
            out[static_cast<Eigen::Index>(k)] -= root_out[k] * double(H[i][c]);
        });
        return out;
    }
};

}  // namespace exitance

namespace Eigen::internal {

template <class Right>
struct generic_product_impl<exitance::ScaledOperator, Right, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<exitance::ScaledOperator, Right,
                                generic_product_impl<exitance::ScaledOperator, Right>> {
    template <class Target>
    static void scaleAndAddTo(Target& target, const exitance::ScaledOperator& left,
                              const Right& right, const double& factor) {
        target.noalias() += factor * left.apply(right);
    }
};

}  // namespace Eigen::internal

namespace exitance {

namespace {

// Products between two looks at the residual. A restart forgets the directions gone so far; with
// five, a room of reflectance 0.9 needs a product or two more than without restarts.
constexpr int products_per_step = 5;

using Unknowns = Eigen::Map<Eigen::VectorXd>;

template <class Method>
void improve(Method& method, const ScaledOperator& matrix, int iterations,
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

double Krylov::sweep() {
    const std::size_t columns = system_.columns.count;
    const std::uint64_t before = transport_.counters().gathers;
    const ScaledOperator matrix(transport_, system_.rows(), columns, root_in_, root_out_);
    if (transport_.symmetric()) {
        Eigen::ConjugateGradient<ScaledOperator, Eigen::Lower | Eigen::Upper,
                                 Eigen::IdentityPreconditioner>
            method;
        improve(method, matrix, products_per_step, right_, y_);
    } else {
        Eigen::BiCGSTAB<ScaledOperator, Eigen::IdentityPreconditioner> method;
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
