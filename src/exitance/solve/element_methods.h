// SPDX-License-Identifier: Apache-2.0
// The closed list of solvers and transports of the linear system; a new one is added here, and its
// name is an option, a row of --compare and a case of every analytic test.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "exitance/solve/element_solver.h"

namespace exitance {

struct ElementMethod {
    std::string_view name;
    std::string_view what;
    std::unique_ptr<ElementSolver> (*make)(const ElementSystem&, Transport&,
                                           const ElementSolverOptions&);
    bool bears_samples;  ///< a transport whose every product is another sample
    bool samples_rows;   ///< of links a few rows cost more than a whole product
};

/// Solvers besides adaptive shooting (solve/shooting.h), which works on vertices and refines.
std::span<const ElementMethod> element_methods();

/// Throws Error(wrong_use) with a suggestion for a name that is not in the list.
const ElementMethod& element_method(const std::string& name);

inline constexpr std::string_view adaptive_shooting = "shooting";
inline constexpr std::string_view adaptive_gathering = "gathering";
inline constexpr std::array<std::string_view, 5> transports{"dense", "sparse", "on-the-fly",
                                                            "links", "stochastic"};

/// Whether the solver and the transport, both in their lists, can be had together.
bool go_together(const ElementMethod& method, std::string_view transport);

}  // namespace exitance
