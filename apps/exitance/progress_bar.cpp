// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "human_number.h"

namespace exitance::cli {

namespace {

bool shows_bar(const Reporting& reporting) {
    return !reporting.quiet && reporting.log == "bar" && ::isatty(STDERR_FILENO) == 1;
}

std::size_t terminal_columns() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

}  // namespace

void Reporting::add_to(CLI::App& command) {
    CLI::Option* silent = command.add_flag("--quiet,-q", quiet, "print nothing but errors");
    command
        .add_option("--log", log,
                    "progress on stderr: a bar if that is a terminal, or one JSON object per line "
                    "and step; csv: a table on stdout, one line per sweep, with the exitance of "
                    "each element if they are few")
        ->type_name("bar|json|csv")
        ->check(CLI::IsMember({"bar", "json", "csv"}).description(""))
        ->default_str(log)
        ->excludes(silent);
}

double share_done(const Progress& progress) {
    const double left = std::clamp(progress.fraction_left, 0.0, 1.0);
    if (progress.even) return 1 - left;
    // Without a target: one part in a thousand, an unshot share that no picture shows.
    const double target = std::clamp(progress.fraction_target.value_or(1e-3), 1e-9, 0.999);
    if (left <= target) return 1;
    return std::log(left) / std::log(target);
}

std::string json_line(const Progress& progress) {
    nlohmann::ordered_json line = {{"phase", progress.phase},
                                   {"seconds", progress.seconds},
                                   {"fraction_left", progress.fraction_left},
                                   {"shots", progress.shots},
                                   {"rays", progress.rays},
                                   {"vertices", progress.vertices}};
    if (progress.error) line["error"] = *progress.error;
    return line.dump();
}

std::string bar_line(const Progress& progress, std::size_t columns) {
    constexpr std::size_t cells = 20;
    const double done = share_done(progress);
    const auto full = static_cast<std::size_t>(done * cells);
    std::string bar;
    for (std::size_t i = 0; i < cells; ++i) bar += i < full ? "█" : "─";
    const double rate = progress.seconds > 0 ? double(progress.rays) / progress.seconds : 0;
    const std::string head = fmt::format("{:<10.10} ", progress.phase);
    std::string tail = fmt::format(" {:3.0f} %  ", 100 * done);
    if (!progress.even) tail += fmt::format("unshot {}  ", human_percent(progress.fraction_left));
    if (progress.shots > 0) tail += fmt::format("{} shots  ", progress.shots);
    if (!progress.even || progress.rays > 0) tail += fmt::format("{} rays/s  ", human_count(rate));
    if (!progress.even)
        tail += fmt::format("{} vertices  ", human_count(double(progress.vertices)));
    if (progress.error) tail += fmt::format("error {}  ", human_percent(*progress.error));
    tail += fmt::format("{:.0f} s", progress.seconds);
    // Head and tail are ASCII, so that bytes are columns.
    const std::size_t used = head.size() + cells;
    if (columns <= used) return head.substr(0, columns);
    return head + bar + tail.substr(0, columns - used);
}

std::string csv_header(const Progress& progress) {
    std::string line = "sweep,residual,unshot,seconds";
    for (std::size_t i = 0; i < progress.exitance.size(); ++i) line += fmt::format(",B{}", i + 1);
    return line;
}

std::string csv_line(const Progress& progress) {
    std::string line =
        fmt::format("{:.6g},{},{:.6g},{:.4f}", progress.sweeps.value_or(0),
                    progress.residual ? fmt::format("{:.6g}", *progress.residual) : "",
                    progress.fraction_left, progress.seconds);
    for (const double B : progress.exitance) line += fmt::format(",{:.6g}", B);
    return line;
}

namespace {

// One line when another sweep is full, and one at the end.
Observer csv_observer() {
    return [next = 1.0, first = true](const Progress& progress) mutable {
        if (!progress.sweeps) return;
        const bool last = progress.fraction_left <= progress.fraction_target.value_or(0);
        if (*progress.sweeps < next - 1e-9 && !last) return;
        next = std::floor(*progress.sweeps + 1e-9) + 1;
        if (first) std::puts(csv_header(progress).c_str());
        first = false;
        std::puts(csv_line(progress).c_str());
    };
}

}  // namespace

Observer make_observer(const Reporting& reporting) {
    if (reporting.quiet) return {};
    if (reporting.log == "csv") return csv_observer();
    if (reporting.log == "json")
        return [](const Progress& progress) {
            std::fprintf(stderr, "%s\n", json_line(progress).c_str());
        };
    if (!shows_bar(reporting)) return {};
    // Ten times a second is what an eye follows.
    return [clock = Stopwatch(), last = -1.0](const Progress& progress) mutable {
        const double now = clock.seconds();
        if (now - last < 0.1) return;
        last = now;
        std::fprintf(stderr, "\r%s\x1b[K", bar_line(progress, terminal_columns() - 1).c_str());
        std::fflush(stderr);
    };
}

void clear_bar(const Reporting& reporting) {
    if (!shows_bar(reporting)) return;
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
}

}  // namespace exitance::cli
