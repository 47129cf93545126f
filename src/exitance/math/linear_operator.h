// SPDX-License-Identifier: Apache-2.0
// A linear operator that is known by its products alone, for Eigen's iterative solvers.
#pragma once

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <functional>
#include <utility>

namespace exitance {

class LinearOperator;

}  // namespace exitance

namespace Eigen::internal {

template <>
struct traits<exitance::LinearOperator> : traits<SparseMatrix<double>> {};

}  // namespace Eigen::internal

namespace exitance {

class LinearOperator : public Eigen::EigenBase<LinearOperator> {
  public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum {
        ColsAtCompileTime = Eigen::Dynamic,
        MaxColsAtCompileTime = Eigen::Dynamic,
        IsRowMajor = false
    };
    using Apply = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

    /// Square; `apply(x)` is its product with x.
    LinearOperator(Eigen::Index size, Apply apply) : size_(size), apply_(std::move(apply)) {}

    Eigen::Index rows() const { return size_; }
    Eigen::Index cols() const { return size_; }
    Eigen::VectorXd apply(const Eigen::VectorXd& x) const { return apply_(x); }

    template <class Right>
    Eigen::Product<LinearOperator, Right, Eigen::AliasFreeProduct> operator*(
        const Eigen::MatrixBase<Right>& right) const {
        return {*this, right.derived()};
    }

  private:
    Eigen::Index size_;
    Apply apply_;
};

}  // namespace exitance

namespace Eigen::internal {

template <class Right>
struct generic_product_impl<exitance::LinearOperator, Right, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<exitance::LinearOperator, Right,
                                generic_product_impl<exitance::LinearOperator, Right>> {
    template <class Target>
    static void scaleAndAddTo(Target& target, const exitance::LinearOperator& left,
                              const Right& right, const double& factor) {
        target.noalias() += factor * left.apply(right);
    }
};

}  // namespace Eigen::internal
