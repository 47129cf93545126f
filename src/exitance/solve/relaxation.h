// SPDX-License-Identifier: Apache-2.0
// Relaxation: one row after the other is made right, and what that changes is sent on at once, so
// that H = F R holds all the time.
#pragma once

#include "exitance/solve/element_solver.h"

namespace exitance {

class Relaxation : public ElementSolver {
  public:
    using ElementSolver::ElementSolver;

  protected:
    /// R_i += ΔR, H += F_·i ΔR.
    void add(std::size_t i, std::span<const float> change);
    /// A step ends after so many rows: a sixteenth of a sweep, so that it can be interrupted.
    std::size_t rows_per_step() const { return std::max<std::size_t>(1, system_.rows() / 16); }
    double as_sweeps(std::size_t relaxed) const {
        return static_cast<double>(relaxed) / static_cast<double>(system_.rows());
    }
};

/// The rows in their order.
class GaussSeidel final : public Relaxation {
  public:
    using Relaxation::Relaxation;

  private:
    double sweep() override;
    std::size_t next_ = 0;
};

/// The row with most unshot flux first: progressive shooting (Southwell 1940; Cohen, Chen, Wallace
/// & Greenberg 1988; Gortler, Cohen & Slusallek 1994 on why these are the same). With overshooting
/// it sends along what it will reflect of the ambient light (Feda & Purgathofer 1992).
class Southwell final : public Relaxation {
  public:
    Southwell(const ElementSystem& system, Transport& transport,
              const ElementSolverOptions& options);

  private:
    double sweep() override;
    struct Brightest {
        std::size_t row = 0;
        float moved = 0;             ///< flux, Columns::magnitude
        std::vector<double> unshot;  ///< flux of all rows, per column, signed
        Brightest& operator+=(const Brightest& other);
    };
    /// The row whose shot moves most, with `spread` of irradiance sent along.
    Brightest brightest(std::span<const float> spread) const;
    /// Irradiance that all that is unshot would add on average: U / (A (1 − ρ)), per column.
    std::vector<float> ambient(std::span<const double> unshot) const;

    std::vector<double> absorbing_;  ///< Σ A (1 − ρ) per column
    std::vector<float> spread_;      ///< by what was unshot one shot ago
};

}  // namespace exitance
