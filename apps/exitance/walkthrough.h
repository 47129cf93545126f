// SPDX-License-Identifier: Apache-2.0
// What view, solve --view, prorad -s and radview share: an address, a browser that opens it, and
// the wait until the last page has closed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "exitance/pipeline.h"
#include "exitance/run/progress.h"
#include "exitance/scene/scene.h"
#include "exitance/solve/options.h"
#include "live_solve.h"
#include "progress_bar.h"
#include "view_server.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace exitance::cli {

struct WalkthroughOptions {
    int port = 0;               ///< on 127.0.0.1; 0: any that is free
    bool open = true;           ///< a browser
    bool keep = false;          ///< stay when the last page closes
    bool solve_to_end = false;  ///< closing the last page does not end a solve

    /// Adds --port, --no-open and --keep to `command`; the targets are this object's.
    void add_to(CLI::App& command, CLI::Option* excluded);
    /// Adds --no-open alone, which makes sense with the option `with`, if that is not empty.
    CLI::Option* add_no_open(CLI::App& command, const std::string& with = "");
};

class Walkthrough {
  public:
    /// Serves from now on (`solution`, if there is one already), prints the address and opens a
    /// browser as asked.
    Walkthrough(const WalkthroughOptions& options, const Reporting& reporting,
                const std::optional<std::filesystem::path>& solution = {});

    /// Lights `scene` while pages watch, as solve_live() does.
    Lit light(const Scene& scene, const SolveOptions& solving, const std::filesystem::path& file,
              const Cancel& interrupt, const Snapshots& snapshots, Resumption* resumed = nullptr);

    /// Returns when the last page has closed, unless they are to stay, or on `interrupt`.
    void stay(const Cancel& interrupt) const;
    /// The same, but where no browser could be opened, nor anybody has come by himself, nobody is
    /// waited for.
    void stay_if_watched(const Cancel& interrupt) const;

  private:
    WalkthroughOptions options_;
    Reporting reporting_;
    ViewServer server_;
    bool expects_page_ = true;
};

}  // namespace exitance::cli
