// SPDX-License-Identifier: Apache-2.0
// exitance manual: the commands and options as Markdown, from their declarations.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "commands.h"
#include "help_text.h"

namespace exitance::cli {

void add_manual(CLI::App& app) {
    CLI::App& command =
        *app.add_subcommand("manual", "print every command and option as a Markdown page");
    command.footer("Example:\n  exitance manual > manual.md");
    command.callback([&app] { std::fputs(manual(app).c_str(), stdout); });
}

}  // namespace exitance::cli
