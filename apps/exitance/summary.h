// SPDX-License-Identifier: Apache-2.0
// What is said when the work is done.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"
#include "exitance/solve/options.h"
#include "reached_error.h"

namespace exitance::cli {

/// Said after Ctrl-C.
inline constexpr const char* stopped_early = "stopped early; what is solved so far is kept";

/// One line on stderr per thing that the readers took for granted, and per warning.
void print_findings(const Scene& scene);

/// A line on stderr if a solver is taken that is neither asked for nor the usual one. Throws as
/// require_possible().
void print_choice(const SolveOptions& options);

/// A line on stderr where a scene's file might be taken for a solution.
void print_lit_anew(const std::filesystem::path& scene);

/// As people read it: light that was sent on although it is not there (unshot < 0) is no part of
/// the sum, but of what is missing in it.
EnergyBalance shown(EnergyBalance energy);

/// "1.8 % ± 0.2 % (…)", or how large it may be where the points do not tell more.
std::string error_text(const Solution& solution);

/// "what camera 'door' sees and grid 'desks'"
std::string focus_text(const RefinedFor& what);

/// What --memory has left undone; empty if nothing.
std::string memory_text(const Solution& solution);

/// The solution in a few lines: size, energy balance, error estimate, work; with an `aim` also
/// whether that was missed.
std::string summary(const Solution& solution, const std::filesystem::path& file, double seconds,
                    const std::optional<Aim>& aim);

}  // namespace exitance::cli
