// SPDX-License-Identifier: Apache-2.0
// Declared options (run/options.h) as flags of a subcommand, and as keys of a project's [solve].
#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/run/options.h"
#include "exitance/scene/scene.h"

namespace CLI {
class App;
}

namespace exitance::cli {

/// Stores the settings of a project in `options`. Throws Error(bad_input) with the place of one
/// that is unknown or out of range.
void apply_settings(const std::vector<Setting>& settings, const Options& options);

/// What the command line said for declared options; the values are stored by `apply`.
class GivenOptions {
  public:
    /// Adds a flag to `command` for each of `options`, whose targets must outlive it, under the
    /// heading `group`. A switch `x` becomes --x and --no-x.
    GivenOptions(CLI::App& command, const std::string& group, Options options);
    GivenOptions(const GivenOptions&) = delete;  // the flags refer to it
    GivenOptions& operator=(const GivenOptions&) = delete;

    /// Stores `settings` first, then what the command line gave. Throws as apply_settings().
    void apply(const std::vector<Setting>& settings) const;

  private:
    Options options_;
    std::map<std::string, std::string> given_;
};

}  // namespace exitance::cli
