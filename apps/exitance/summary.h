// SPDX-License-Identifier: Apache-2.0
// What is said when the work is done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"

namespace exitance::cli {

/// Said after Ctrl-C.
inline constexpr const char* stopped_early = "stopped early; what is solved so far is kept";

/// One line per warning of a reader, on stderr.
void print_warnings(const std::vector<Problem>& warnings);

/// The solution in a few lines: size, energy balance, error estimate, work.
std::string summary(const Solution& solution, const std::filesystem::path& file, double seconds);

}  // namespace exitance::cli
