// SPDX-License-Identifier: Apache-2.0
#include "walkthrough.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <thread>

namespace exitance::cli {

namespace {

/// Asks the desktop to open `url`; whether it found something to do that with.
bool open_in_browser(const std::string& url) {
    std::string opener = "xdg-open", address = url;
    const std::array<char*, 3> arguments{opener.data(), address.data(), nullptr};
    posix_spawn_file_actions_t quietly;
    ::posix_spawn_file_actions_init(&quietly);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        ::posix_spawn_file_actions_addopen(&quietly, stream, "/dev/null", 1 /* O_WRONLY */, 0);
    pid_t child = 0;
    const bool started =
        ::posix_spawnp(&child, opener.c_str(), &quietly, nullptr, arguments.data(), environ) == 0;
    ::posix_spawn_file_actions_destroy(&quietly);
    int status = 0;
    return started && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
           WEXITSTATUS(status) == 0;
}

}  // namespace

void WalkthroughOptions::add_to(CLI::App& command, CLI::Option* excluded) {
    command.add_option("--port", port, "port on 127.0.0.1 (0: any that is free)")
        ->type_name("number")
        ->check(CLI::Range(0, 65535).description(""))
        ->default_str("0")
        ->excludes(excluded);
    add_no_open(command)->excludes(excluded);
    command.add_flag("--keep", keep, "stay when the last page closes, until Ctrl-C")
        ->excludes(excluded);
}

CLI::Option* WalkthroughOptions::add_no_open(CLI::App& command, const std::string& with) {
    CLI::Option* option = command.add_flag_callback(
        "--no-open", [this] { open = false; },
        with.empty() ? "open no browser: the address is printed"
                     : "with " + with + ": open no browser, the address is printed");
    return with.empty() ? option : option->needs(command.get_option(with));
}

Walkthrough::Walkthrough(const WalkthroughOptions& options, const Reporting& reporting,
                         const std::optional<std::filesystem::path>& solution)
    : options_(options), reporting_(reporting), server_(options.port) {
    if (solution) server_.show(*solution);
    // The address is for whoever waits for it, be it a person or a program.
    fmt::print("{}\n", server_.url());
    std::fflush(stdout);
    if (!options_.open) return;
    expects_page_ = open_in_browser(server_.url());
    if (!expects_page_ && !reporting_.quiet)
        fmt::print(stderr, "exitance: no browser could be opened; open this address in one\n");
}

Lit Walkthrough::light(const Scene& scene, const SolveOptions& solving,
                       const std::filesystem::path& file, const Cancel& interrupt,
                       const Snapshots& snapshots, Resumption* resumed) {
    Lit lit = solve_live(scene, solving, server_, file, make_observer(reporting_), interrupt,
                         options_.keep || options_.solve_to_end, snapshots, resumed);
    clear_bar(reporting_);
    return lit;
}

void Walkthrough::stay(const Cancel& interrupt) const {
    while (!interrupt.requested() && (options_.keep || !server_.deserted()))
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

void Walkthrough::stay_if_watched(const Cancel& interrupt) const {
    if (expects_page_ || server_.has_pages()) stay(interrupt);
}

}  // namespace exitance::cli
