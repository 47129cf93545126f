// SPDX-License-Identifier: Apache-2.0
// Solver, stop and observer are three things, and one loop runs them.
#pragma once

#include <cstdint>
#include <optional>

#include "exitance/run/progress.h"

namespace exitance {

/// Improves a solution step by step. One of the closed list of solvers (docs/design.md).
class Solver {
  public:
    virtual ~Solver() = default;

    /// One unit of work, well below a second. Returns false when nothing is left to do.
    virtual bool step() = 0;
    /// Light still to be distributed / emitted light, both luminance-weighted fluxes.
    virtual double unshot() const = 0;
    /// The share at which what is missing no longer matters for the error asked for.
    virtual double enough() const = 0;
    /// What the next step distributes / emitted light.
    virtual double next_shot() const = 0;
    virtual Progress progress() const = 0;
};

enum class Ended {
    converged,  ///< by its own rule
    out_of_time,
    cancelled
};

/// When to end; whichever comes first.
struct Stop {
    std::optional<double> unshot;     ///< share of the emitted light; default: Solver::enough()
    std::optional<double> seconds;    ///< since `clock` was started
    std::optional<double> next_shot;  ///< least that is worth a step, a share of the emitted light
    const Cancel* cancel = nullptr;

    /// Whether the user or the time that `clock` shows says so, whatever the solver has reached.
    std::optional<Ended> interruption(const Stopwatch& clock) const {
        if (cancel && cancel->requested()) return Ended::cancelled;
        if (seconds && clock.seconds() >= *seconds) return Ended::out_of_time;
        return {};
    }
};

/// Runs `solver` until `stop` says so; `observe` hears of every step.
Ended run(Solver& solver, const Stop& stop, const Stopwatch& clock, const Observer& observe);

}  // namespace exitance
