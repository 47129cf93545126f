// SPDX-License-Identifier: Apache-2.0
// The command line. The only place that prints or exits.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "commands.h"
#include "exitance/run/error.h"

int main(int argc, char** argv) {
    CLI::App app{"Exitance computes how light fills a space, once, for every point of view."};
    app.name("exitance");
    app.require_subcommand(1);
    exitance::cli::add_solve(app);
    exitance::cli::add_render(app);
    exitance::cli::add_probe(app);
    exitance::cli::add_info(app);
    exitance::cli::add_prorad(app);
    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const exitance::Error& error) {
        std::fprintf(stderr, "exitance: %s\n", error.what());
        return error.exit_code();
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "exitance: out of memory\n");
        return 4;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "exitance: %s\n", error.what());
        return 4;
    }
}
