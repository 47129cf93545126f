// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/solver.h"

namespace exitance {

Ended run(Solver& solver, const Stop& stop, const Stopwatch& clock, const Observer& observe) {
    while (true) {
        if (const auto interrupted = stop.interruption(clock)) return *interrupted;
        const double target = stop.unshot.value_or(solver.enough());
        if (solver.unshot() <= target) return Ended::converged;
        if (stop.next_shot && solver.next_shot() < *stop.next_shot) return Ended::converged;
        if (!solver.step()) return Ended::converged;
        if (observe) {
            Progress progress = solver.progress();
            progress.seconds = clock.seconds();
            progress.fraction_target = target;
            observe(progress);
        }
    }
}

}  // namespace exitance
