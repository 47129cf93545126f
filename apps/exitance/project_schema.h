// SPDX-License-Identifier: Apache-2.0
// A JSON Schema of project files, for editors.
#pragma once

#include <string>

namespace exitance::cli {

/// From the declarations of the tables, their keys and the options of solve.
std::string project_schema();

}  // namespace exitance::cli
