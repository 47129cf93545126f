// SPDX-License-Identifier: Apache-2.0
// Whether a solve came to the error that it aimed at, and if not, why.
#pragma once

#include <optional>
#include <string>

#include "exitance/solution/solution.h"

namespace exitance::cli {

/// What a solve aimed at, and what ended it.
struct Aim {
    double error = 0;  ///< as SolveOptions::error
    Ended ended = Ended::converged;
};

/// As its file tells; nothing if that does not say which error.
std::optional<Aim> aim_of(const Solution& solution);

/// Whether the standard error of the estimate leaves it a value at all.
bool tells_a_value(const ErrorEstimate& estimate);

/// By the estimate and its standard error; nothing: there is none, or it leaves that open.
std::optional<bool> reached(const Solution& solution, const Aim& aim);

/// Why the error is not reached, or may not be, and what the user can do; empty if it is.
std::string unreached_text(const Solution& solution, const Aim& aim);

/// "stopped by --time 5 s", or empty.
std::string stopped_text(const Solution& solution);

}  // namespace exitance::cli
