// SPDX-License-Identifier: Apache-2.0
// The walkthrough and its solution as one file that works from disk.
#pragma once

#include <filesystem>
#include <ostream>

namespace exitance::cli {

/// Writes the page with program, looks and the solution file `solution` inside. Throws Error if
/// the solution cannot be read or is larger than browsers take in a page (256 MiB).
void write_self_contained_page(std::ostream& out, const std::filesystem::path& solution);

}  // namespace exitance::cli
