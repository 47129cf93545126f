// SPDX-License-Identifier: Apache-2.0
// Files that a project names.
#pragma once

#include <filesystem>
#include <string>

#include "exitance/scene/formats/toml_table.h"
#include "exitance/scene/read_options.h"

namespace exitance {

/// The file that `key` of `table` names, looked up in the project's `folder`. Throws Error at its
/// value if there is none, or if it lies outside of where `options` hold it.
std::filesystem::path named_file(const TomlTable& table, const std::string& key,
                                 const std::filesystem::path& folder, const ReadOptions& options);

}  // namespace exitance
