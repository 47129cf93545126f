// SPDX-License-Identifier: Apache-2.0
// Gathering: every element collects what all others sent in the sweep before (Goral, Torrance,
// Greenberg & Battaile 1984 solved this system; sweep by sweep it is the Neumann series, one more
// reflection each).
#pragma once

#include "exitance/solve/element_solver.h"

namespace exitance {

/// Over a transport that is random, stochastic Jacobi iteration (Bekaert 1999): first the light is
/// followed reflection by reflection, ΔR ← ρ F̂ ΔR, fewer rays each time; then whole products of
/// what that gave are averaged, H ← H + (F̂ R − H) / m, until what they differ by no longer matters.
class Jacobi final : public ElementSolver {
  public:
    using ElementSolver::ElementSolver;

    /// Of a random transport: flux that the mean of the products may be wrong by, by how much the
    /// last one changed it; before there are two, everything.
    double unshot() const override;
    double enough() const override;
    double next_shot() const override { return unshot(); }
    Progress progress() const override;

  private:
    /// R ← ρ (D + H), H = F R.
    double sweep() override;
    void sweep_sampled();
    double patience() const override { return transport_.random() ? 1e6 : 32; }

    double products_ = 0;  ///< whole ones in the mean
};

}  // namespace exitance
