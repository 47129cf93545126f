// SPDX-License-Identifier: Apache-2.0
// Conjugate gradients on the system made symmetric. With A F = S symmetric and y = √(A/ρ) R,
//
//     (I − √(ρ/A) S √(ρ/A)) y = √(A ρ) D,
//
// which is positive definite, as no enclosure reflects all light. Rows that reflect nothing need
// no care: their root is 0, so y = 0 and R = √(ρ/A) y = 0 without a division by ρ.
#pragma once

#include <span>

#include "exitance/solve/element_solver.h"

namespace exitance {

/// All columns are one system of rows × columns unknowns, so that one product serves them all.
/// Conjugate gradients (Hestenes & Stiefel 1952) where the transport is symmetric, BiCGSTAB (van
/// der Vorst 1992) where it is not; Eigen's, restarted every few products so that the one loop
/// can look at it.
class Krylov final : public ElementSolver {
  public:
    Krylov(const ElementSystem& system, Transport& transport, const ElementSolverOptions& options);

  private:
    double sweep() override;
    /// y becomes (I − √(ρ A) F √(ρ/A)) y.
    void multiply(std::span<double> y);

    std::vector<double> root_in_;   ///< √(ρ/A), rows × columns
    std::vector<double> root_out_;  ///< √(ρ A)
    std::vector<double> y_, right_;
};

}  // namespace exitance
