// SPDX-License-Identifier: Apache-2.0
// exitance manual: the commands and options as Markdown, from their declarations.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "help_text.h"
#include "project_schema.h"

namespace exitance::cli {

void add_manual(CLI::App& app) {
    CLI::App& command =
        *app.add_subcommand("manual", "print every command and option as a Markdown page");
    const auto schema = std::make_shared<bool>(false);
    command.add_flag("--schema", *schema, "print the JSON Schema of project files instead");
    command.footer(
        "Examples:\n"
        "  exitance manual > manual.md\n"
        "  exitance manual --schema > project.schema.json");
    command.callback(
        [&app, schema] { std::fputs((*schema ? project_schema() : manual(app)).c_str(), stdout); });
}

}  // namespace exitance::cli
