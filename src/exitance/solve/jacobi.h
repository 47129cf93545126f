// SPDX-License-Identifier: Apache-2.0
// Gathering: every element collects what all others sent in the sweep before (Goral, Torrance,
// Greenberg & Battaile 1984 solved this system; sweep by sweep it is the Neumann series, one more
// reflection each).
#pragma once

#include "exitance/solve/element_solver.h"

namespace exitance {

class Jacobi final : public ElementSolver {
  public:
    using ElementSolver::ElementSolver;

  private:
    /// R ← ρ (D + H), H = F R.
    double sweep() override;
};

}  // namespace exitance
