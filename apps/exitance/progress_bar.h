// SPDX-License-Identifier: Apache-2.0
// What long work shows while it runs, on stderr: a bar on a terminal, or one JSON line per step.
#pragma once

#include <string>

#include "exitance/run/progress.h"

namespace CLI {
class App;
}

namespace exitance::cli {

struct Reporting {
    bool quiet = false;
    std::string log = "bar";

    /// Adds --quiet and --log to `command`; the targets are this object's.
    void add_to(CLI::App& command);
};

/// Share of the work that is done, 0 … 1. The residual of an iteration falls by about the same
/// factor per step, so the bar is linear in its logarithm from 1 down to the target; other work
/// says that it falls evenly.
double share_done(const Progress& progress);

/// One JSON object on one line, without the newline.
std::string json_line(const Progress& progress);

/// sweep, residual (empty where the solver has none), unshot share, seconds, B per element.
std::string csv_header(const Progress& progress);
std::string csv_line(const Progress& progress);

/// "shooting  ███───  52 %  unshot 3.1 %  …", at most `columns` characters.
std::string bar_line(const Progress& progress, std::size_t columns);

/// Shows nothing if quiet, or if neither a terminal nor a log is there to show it on.
Observer make_observer(const Reporting& reporting);

/// Removes the bar from the terminal, before anything else is printed.
void clear_bar(const Reporting& reporting);

}  // namespace exitance::cli
