// SPDX-License-Identifier: Apache-2.0
// What all solvers of the linear system share: R, H = F R, and how far they are from R = ρ (D + H).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/solve/element_system.h"
#include "exitance/solve/solver.h"

namespace exitance {

struct ElementSolverOptions {
    double error = 0.02;           ///< RMS error of irradiance relative to its mean to aim at
    std::optional<double> unshot;  ///< share of the emitted light to stop at, if it is given
    bool overshoot = true;         ///< Southwell's
    std::uint64_t seed = 0;        ///< the stochastic solver's
};

/// Starts at R = 0. `system` and `transport` outlive the solver.
class ElementSolver : public Solver {
  public:
    ElementSolver(const ElementSystem& system, Transport& transport,
                  const ElementSolverOptions& options);

    bool step() final;
    /// Σ A |ρ (D + H) − R| over Φ, the emitted flux: flux that was received and not yet sent on.
    double unshot() const override { return unshot_; }
    double enough() const override;
    double next_shot() const override { return unshot_; }
    Progress progress() const override;

    /// Root of Σ A (ρ (D + H) − R)², relative to that at the start, all columns weighted.
    double residual() const { return residual_; }
    double sweeps() const { return sweeps_; }
    /// R, one row per element.
    const RowField& reflected() const { return reflected_; }
    /// D + F R.
    RowField irradiance() const;

  protected:
    /// Improves R and leaves H = F R; returns how many times as much work as one product with F.
    virtual double sweep() = 0;

    /// Where so many sweeps bring nothing, the rounding of the fields is reached.
    virtual double patience() const { return 32; }

    /// ρ (D + H) − R of row `i` into `out` [stride].
    void residual_of(std::size_t i, std::span<float> out) const;
    /// Flux below which what is unshot does not matter for the error asked for, over Φ.
    double negligible() const;
    /// Flux that noise may be wrong by on average, over Φ, if `reflected` is what is noisy.
    double enough_noise(const RowField& reflected) const;
    /// Σ A |field| over Φ.
    double flux_of(const RowField& field) const;

    const ElementSystem& system_;
    Transport& transport_;
    ElementSolverOptions options_;
    RowField reflected_;   ///< R
    RowField irradiance_;  ///< H = F R

  private:
    void find_residual();

    double sweeps_ = 0;
    double unshot_ = 1, residual_ = 1, square_at_start_ = 0;
    double mean_irradiance_ = 0, open_area_ = 0, most_reflected_ = 0;
    double least_unshot_ = 0, sweep_of_least_ = 0;
};

}  // namespace exitance
