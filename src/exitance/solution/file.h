// SPDX-License-Identifier: Apache-2.0
// A solution as a binary glTF that any viewer shows lit (docs/solution-file.md).
#pragma once

#include <filesystem>

#include "exitance/solution/solution.h"

namespace exitance {

/// Writes `solution` to `path`; the same solution gives the same bytes. The file appears whole or
/// not at all. Throws Error(could_not_finish) if it cannot be written, if it would pass the 4 GiB
/// of a .glb, or if a value is not finite.
void write_solution(const Solution& solution, const std::filesystem::path& path);

/// Reads what write_solution() wrote. Vertices come back grouped by material, triangles in their
/// order; irradiance is accurate to float rounding. Throws Error(bad_input) for anything else.
Solution read_solution(const std::filesystem::path& path);

/// Whether `path` is a binary glTF that carries a solution. False for whatever cannot be read.
bool is_solution(const std::filesystem::path& path);

}  // namespace exitance
