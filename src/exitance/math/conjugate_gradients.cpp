// SPDX-License-Identifier: Apache-2.0
#include "exitance/math/conjugate_gradients.h"

#include "exitance/math/linear_operator.h"

namespace exitance {

namespace {

using Vector = Eigen::VectorXd;

Eigen::Map<const Vector> mapped(const std::vector<double>& v) {
    return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// Jacobi's preconditioner as Eigen wants one; the operator does not tell its diagonal.
class ByDiagonal {
  public:
    ByDiagonal() = default;
    void set(Vector diagonal) { diagonal_ = std::move(diagonal); }

    template <class Matrix>
    ByDiagonal& analyzePattern(const Matrix&) {
        return *this;
    }
    template <class Matrix>
    ByDiagonal& factorize(const Matrix&) {
        return *this;
    }
    template <class Matrix>
    ByDiagonal& compute(const Matrix&) {
        return *this;
    }
    template <class Right>
    Vector solve(const Right& right) const {
        return right.cwiseQuotient(diagonal_);
    }
    Eigen::ComputationInfo info() const { return Eigen::Success; }

  private:
    Vector diagonal_;
};

}  // namespace

double conjugate_gradients(
    const std::function<std::vector<double>(const std::vector<double>&)>& apply,
    const std::vector<double>& diagonal, const std::vector<double>& b, std::vector<double>& x,
    double tolerance, std::size_t most) {
    const LinearOperator matrix(static_cast<Eigen::Index>(b.size()),
                                [&](const Vector& v) -> Vector {
                                    return mapped(apply(std::vector<double>(v.begin(), v.end())));
                                });
    Eigen::ConjugateGradient<LinearOperator, Eigen::Lower | Eigen::Upper, ByDiagonal> method;
    method.preconditioner().set(mapped(diagonal));
    method.setTolerance(tolerance);
    method.setMaxIterations(static_cast<Eigen::Index>(most));
    method.compute(matrix);
    const Vector found = method.solveWithGuess(mapped(b), mapped(x));
    if (found.allFinite()) x.assign(found.begin(), found.end());
    return method.error();
}

}  // namespace exitance
