// SPDX-License-Identifier: Apache-2.0
// Questions to ask about files before the long work that reads and fills them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace exitance::cli {

/// Throws Error(wrong_use) if `output` would replace `input` or has none of `endings` (a device
/// such as /dev/null may have any name, and everything may if there are no endings),
/// Error(could_not_finish) if it could not be written. `option` is what it was given by.
void require_output(const std::filesystem::path& output, const std::filesystem::path& input,
                    const std::vector<std::string>& endings,
                    const std::string& option = "--output");

/// Throws Error(wrong_use) if `input` is a solution already.
void require_scene(const std::filesystem::path& input);

}  // namespace exitance::cli
