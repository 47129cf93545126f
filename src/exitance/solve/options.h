// SPDX-License-Identifier: Apache-2.0
// What may be asked of a solve. Everything below `error` follows from it unless set.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exitance/run/options.h"

namespace exitance {

struct SolveOptions {
    double error = 0.02;
    std::optional<std::string> view;
    std::optional<std::string> grid;
    std::optional<double> time;
    std::optional<double> memory;
    std::optional<std::string> solver;  ///< by default as solver_of() says
    std::optional<std::string> transport;
    std::optional<std::string> factors;
    std::optional<std::string> vertices;
    std::optional<double> element_rays;
    std::string groups = "file";
    std::optional<double> unshot;
    std::optional<double> next_shot;
    std::optional<double> patch_size;
    std::optional<double> element_size;
    std::optional<double> min_area;
    bool adaptive = true;
    bool merge = true;
    bool occlusion = true;
    bool overshoot = true;
    std::string form_factor = "lambert";
    int threads = 0;
    std::uint64_t seed = 0;
};

/// Every member of `options` with its name, unit, range and reason; values are read and written
/// through the result.
Options describe(SolveOptions& options);

/// The solver that was asked for; by default gathering, jacobi where a transport asks for elements,
/// or shooting where an option asks for what only it does.
std::string solver_of(const SolveOptions& options);

/// Whether no solver was asked for, and the transport decides on one.
bool goes_with_transport(const SolveOptions& options);

/// Whether the solver is one of those for one exitance per element (element_methods.h).
bool by_elements(const SolveOptions& options);

/// Whether an option is one of theirs; adaptive shooting leaves these unset.
bool of_elements(const std::string& option);

/// Throws Error(wrong_use) for options that cannot be had together, and says why.
void require_possible(const SolveOptions& options);

/// The same unless the solver can go on from a solution (--resume).
void require_resumable(const SolveOptions& options);

}  // namespace exitance
