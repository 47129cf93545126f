// SPDX-License-Identifier: Apache-2.0
// How the command line describes itself: --help on a terminal, docs/manual.md on paper.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace exitance::cli {

/// Lays out the --help of `app` and of every subcommand added later, 100 columns wide.
void use_help_layout(CLI::App& app);

/// Every subcommand with its options as a Markdown page.
std::string manual(const CLI::App& app);

}  // namespace exitance::cli
