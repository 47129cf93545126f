// SPDX-License-Identifier: Apache-2.0
// exitance view: a walk through a solution in the browser, or through a scene while it is lit.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "exitance/pipeline.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "self_contained_page.h"
#include "summary.h"
#include "temporary_folder.h"
#include "walkthrough.h"

namespace exitance::cli {

namespace {

class ViewCommandLine {
  public:
    explicit ViewCommandLine(CLI::App& command)
        : given_(command, "Solving", describe(options_)),
          reading_(command, "Reading a scene", describe(read_options_)) {
        command.add_option("input", input_, "a solution, or a scene that is lit while one watches")
            ->type_name("file")
            ->required();
        auto* html = command.add_option("--html", html_,
                                        "write a page that holds everything and works from disk, "
                                        "instead of serving one");
        html->type_name("file.html");
        command.add_option("--output,-o", output_, "keep the solution of a scene")
            ->type_name("file.glb");
        walking_.add_to(command, html);
        reporting_.add_to(command);
        command.footer(
            "The page is served to browsers on this machine only, at an address that nobody can\n"
            "guess. It ends with Ctrl-C or when the last page closes.\n"
            "\n"
            "Examples:\n"
            "  exitance view cornell.glb\n"
            "  exitance view scenes/cornell.toml --error 0.1 -o cornell.glb\n"
            "  exitance view cornell.glb --html cornell.html");
    }

    void run() {
        reading_.apply({});
        const bool solved = is_solution(input_);
        if (output_ && solved)
            throw Error(Fault::wrong_use, "--output: '" + input_.string() +
                                              "' is a solution already, expected a scene");
        if (output_) require_output(*output_, input_, {".glb"});
        if (html_) require_output(*html_, input_, {".html"}, "--html");
        if (solved) {
            read_solution(input_);  // says what is wrong with it
            given_.apply({});
            html_ ? write_page(input_) : serve(nullptr);
        } else {
            const Scene scene = read_scene(input_, read_options_);
            if (!reporting_.quiet) print_findings(scene), print_lit_anew(input_);
            given_.apply(scene.settings);
            if (!reporting_.quiet) print_choice(options_);
            html_ ? write_page_of(scene) : serve(&scene);
        }
    }

  private:
    SolveOptions options_;
    GivenOptions given_;
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path input_;
    std::optional<std::filesystem::path> html_, output_;
    WalkthroughOptions walking_;
    Reporting reporting_;

    void write_page(const std::filesystem::path& solution) const {
        write_atomically(*html_,
                         [&](std::ostream& out) { write_self_contained_page(out, solution); });
    }

    void write_page_of(const Scene& scene) const {
        const TemporaryFolder folder;
        const std::filesystem::path file = output_.value_or(folder.path() / "solution.glb");
        const Interrupt interrupt;
        write_solution(light(scene, options_, make_observer(reporting_), &interrupt.cancel()),
                       file);
        clear_bar(reporting_);
        write_page(file);
    }

    /// Shows the solution `input_`, or lights `scene` first.
    void serve(const Scene* scene) const {
        const TemporaryFolder folder;
        const Interrupt interrupt;
        Walkthrough walk(walking_, reporting_, scene ? std::nullopt : std::optional(input_));
        if (scene) {
            const Stopwatch watch;
            const std::filesystem::path file = output_.value_or(folder.path() / "solution.glb");
            const Lit lit =
                walk.light(*scene, options_, file, interrupt.cancel(), {.ambient = true});
            if (output_ && !reporting_.quiet) {
                if (lit.stopped) std::puts(stopped_early);
                const std::string said =
                    summary(lit.solution, *output_, watch.seconds(), aim_of(lit.solution));
                std::fputs(said.c_str(), stdout);
                std::fflush(stdout);
            }
        }
        walk.stay(interrupt.cancel());
    }
};

}  // namespace

void add_view(CLI::App& app) {
    CLI::App& command = *app.add_subcommand(
        "view", "walk through a solution in the browser, or watch a scene being lit");
    const auto view = std::make_shared<ViewCommandLine>(command);
    command.callback([view] { view->run(); });
}

}  // namespace exitance::cli
