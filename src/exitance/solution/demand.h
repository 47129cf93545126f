// SPDX-License-Identifier: Apache-2.0
// What is demanded of an adaptive solver, and the best solution that this has led to.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "exitance/solution/error_estimate.h"
#include "exitance/solution/solution.h"
#include "exitance/solve/importance.h"
#include "exitance/solve/options.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

/// The solution as it stands, with its size as counters.
Solution solution_of(const Radiosity& radiosity);

/// The same, with what held-out points say of it.
Solution judged_solution_of(const Radiosity& radiosity, const SolveOptions& options,
                            const Importance* importance);

/// Of the triangles that lie on these patches; no patch: nobody looks.
TriangleImportance importance_of(const std::vector<PatchId>& patches, const Importance& importance);

/// A solver does what should lead to the error `error`; held-out points tell whether that led to
/// the one that is asked for, and if not, more is demanded while that helps.
struct Demand {
    double error;
    const Importance* importance = nullptr;  ///< if there: where it is demanded
    std::optional<double> done{};            ///< the last one that the solver was done with
    double found = INFINITY;                 ///< by the held-out points, the last time
    /// Of the best that they have looked at, which is `solution`, or what was resumed.
    std::optional<ErrorEstimate> best{};
    std::optional<Solution> solution{};
    bool is_of_mesh = false;          ///< `solution` is what the mesh stands for now
    bool risen = false;               ///< more was demanded after they have looked
    std::function<bool()> is_last{};  ///< asked after each: true = nothing leads any further

    /// Looks at what there is. Whether more is demanded now.
    bool rise(const SolveOptions& options, const Radiosity& radiosity);

    /// Whether this error is what is asked for.
    bool met_by(const ErrorEstimate& estimate, const SolveOptions& options) const;

    /// `now` is what the mesh stands for.
    void take_if_better(Solution now);

    /// Begins with a solution that has this error by the same points.
    void resume(const Solution& kept, const std::optional<ErrorEstimate>& estimate,
                const SolveOptions& options);
};

}  // namespace exitance
