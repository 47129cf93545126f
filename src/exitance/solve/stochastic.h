// SPDX-License-Identifier: Apache-2.0
// Stochastic Jacobi iteration: each reflection is sent by a random sample of the elements instead
// of by all (Neumann, Neumann & Bekaert 1996, "Radiosity with well distributed ray sets", in its
// incremental form).
#pragma once

#include "exitance/solve/element_solver.h"

namespace exitance {

/// A series follows the light from the lamps reflection by reflection, ΔR ← ρ F̂ ΔR, until what is
/// left does not matter; F̂ takes a sample of ΔR's rows in proportion to their flux, each for those
/// it stands for. A series is right on average; the mean of many is what is asked for, and how
/// they differ tells how wrong it still is. A small system is its own sample: then this is Jacobi.
/// A transport that is random itself is the sample: as many rays from each row as it has flux.
class StochasticJacobi final : public ElementSolver {
  public:
    StochasticJacobi(const ElementSystem& system, Transport& transport,
                     const ElementSolverOptions& options);

    /// Flux that the mean may be wrong by, by the series' differences; before there are two, all
    /// that is reflected. Of an exact series, what it has not followed yet.
    double unshot() const override;
    double enough() const override;
    double next_shot() const override { return unshot(); }
    Progress progress() const override;

  private:
    double sweep() override;
    /// A mean of n series gets better with their root: slowly, but always.
    double patience() const override { return 1e6; }
    /// F̂ ΔR of a sample of the rows; false if not all of them were in it.
    bool shoot_sampled(RowField& arriving);
    /// ΔR ← ρ F̂ ΔR; false if anything was left to chance.
    bool reflect_sampled();
    void finish_series();

    RowField change_;            ///< ΔR of the series under way
    RowField series_, arrived_;  ///< its sum of ΔR, and of F̂ ΔR
    RowField mean_, mean_arrived_;
    std::vector<double> squares_;  ///< per row: Σ (luminance of a series − mean)², Welford's
    std::uint64_t complete_ = 0, reflections_ = 0;
    bool exact_ = true;          ///< nothing was left to chance so far
    double all_ = 1, left_ = 1;  ///< flux of the first reflection, and what is not followed yet
    double noise_ = 0;
};

}  // namespace exitance
