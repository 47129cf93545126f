// SPDX-License-Identifier: Apache-2.0
// One file per subcommand; each adds itself to the command line.
#pragma once

namespace CLI {
class App;
}

namespace exitance::cli {

void add_convert(CLI::App& app);
void add_exchange(CLI::App& app);
void add_form_factors(CLI::App& app);
void add_info(CLI::App& app);
void add_manual(CLI::App& app);
void add_prorad(CLI::App& app);
void add_probe(CLI::App& app);
void add_radview(CLI::App& app);  ///< as add_view
void add_render(CLI::App& app);
void add_solve(CLI::App& app);
void add_view(CLI::App& app);  ///< not in programs that were built without EXITANCE_VIEWER

}  // namespace exitance::cli
