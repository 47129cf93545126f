// SPDX-License-Identifier: Apache-2.0
// Questions to ask about an output before the long work that fills it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace exitance::cli {

/// Throws Error(wrong_use) if `output` would replace `input` or has none of `endings` (a device
/// such as /dev/null may have any name, and everything may if there are no endings),
/// Error(could_not_finish) if it could not be written.
void require_output(const std::filesystem::path& output, const std::filesystem::path& input,
                    const std::vector<std::string>& endings);

}  // namespace exitance::cli
