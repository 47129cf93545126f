// SPDX-License-Identifier: Apache-2.0
// The command line. The only place that prints or exits.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "commands.h"
#include "exitance/run/error.h"
#include "help_text.h"

namespace {

void describe_program(CLI::App& app) {
    app.name("exitance");
    app.set_version_flag("--version", "exitance " EXITANCE_VERSION, "print the version");
    app.set_help_flag("--help,-h", "print this help");
    app.require_subcommand(1);
    exitance::cli::use_help_layout(app);
    app.failure_message([](const CLI::App* asked, const CLI::Error& error) {
        return std::string("exitance: ") + error.what() + " (" + asked->get_name() +
               " --help says more)\n";
    });
    app.footer(
        "exitance COMMAND --help says more. Exit codes: 0 done, 2 wrong use, 3 bad input,\n"
        "4 could not finish (disk full, out of memory).");
}

void add_commands(CLI::App& app) {
    exitance::cli::add_solve(app);
#ifdef EXITANCE_VIEWER
    exitance::cli::add_view(app);
#endif
    exitance::cli::add_render(app);
    exitance::cli::add_probe(app);
    exitance::cli::add_form_factors(app);
    exitance::cli::add_exchange(app);
    exitance::cli::add_convert(app);
    exitance::cli::add_info(app);
    exitance::cli::add_prorad(app);
#ifdef EXITANCE_VIEWER
    exitance::cli::add_radview(app);
#endif
    exitance::cli::add_manual(app);
}

/// CLI11 only says that a command is missing where the one that was typed does not exist.
void require_known_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    const std::string typed = argv[1];
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), typed) == names.end())
        throw exitance::Error(exitance::Fault::wrong_use, "unknown command '" + typed + "'" +
                                                              exitance::suggestion(typed, names));
}

/// The first word that no command took, and the option it may have been meant to be.
exitance::Error unknown_option(const CLI::App& app, const CLI::Error& error) {
    for (const CLI::App* command : app.get_subcommands()) {
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& word : command->remaining())
            if (word.starts_with('-'))
                return {exitance::Fault::wrong_use,
                        "unknown option '" + word + "'" + exitance::suggestion(word, names)};
    }
    return {exitance::Fault::wrong_use, error.what()};
}

int report(const exitance::Error& error) {
    std::fprintf(stderr, "exitance: %s\n", error.what());
    return error.exit_code();
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Exitance computes how light fills a space, once, for every point of view."};
    describe_program(app);
    add_commands(app);
    try {
        require_known_command(app, argc, argv);
        app.parse(argc, argv);
        // A standard output that is closed was not wanted.
        if (std::fflush(stdout) != 0 && errno != EBADF)
            throw exitance::Error(exitance::Fault::could_not_finish,
                                  "what was printed could not be written");
        return 0;
    } catch (const CLI::ExtrasError& error) {
        return report(unknown_option(app, error));
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const exitance::Error& error) {
        return report(error);
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "exitance: out of memory\n");
        return 4;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "exitance: %s\n", error.what());
        return 4;
    }
}
