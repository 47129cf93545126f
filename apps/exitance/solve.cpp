// SPDX-License-Identifier: Apache-2.0
// exitance solve: a scene file goes in, a solution file comes out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "compare_solvers.h"
#include "exitance/pipeline.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "summary.h"
#ifdef EXITANCE_VIEWER
#include "walkthrough.h"
#endif

namespace exitance::cli {

namespace {

constexpr Replies replies{"exitance: stopping, to keep what is solved; again to quit at once\n",
                          "exitance: quit at once, nothing was written\n"};
// What pages are shown is in the file already.
constexpr Replies live_replies{replies.first, "exitance: quit at once\n"};

class SolveCommand {
  public:
    explicit SolveCommand(CLI::App& command)
        : given_(command, "Solving", describe(options_)),
          reading_(command, "Reading a scene", describe(read_options_)) {
        [[maybe_unused]] CLI::Option* scene =
            command
                .add_option(
                    "scene", scene_,
                    "what to light: .toml, .glb, .gltf, .mgf, .rad, .geom, .vs3, .obj, .ply, .stl, "
                    ".fbx, .dae, .3ds or .ifc")
                ->required();
        command
            .add_option(
                "--output,-o", output_,
                "the solution: a glTF file; needed unless --log csv or --compare ask for numbers")
            ->type_name("file.glb");
        command
            .add_option(
                "--resume", resume_,
                "go on from this solution of the same scene, that was stopped or made for a larger "
                "error: begins with its mesh, and returns it if nothing better is found; may be "
                "the file of --output")
            ->type_name("file.glb");
        command.add_flag(
            "--compare", compare_,
            "solve by every solver and transport in turn and print a table instead: "
            "work, time, residual, error by the solution's own held-out points, RMS "
            "difference from the converged solution of even elements (which is not the "
            "truth: what divides elements differs most), memory");
#ifdef EXITANCE_VIEWER
        CLI::Option* view = command.get_option("--view");
        view->excludes("--compare")
            ->expected(0, 1)
            // `solve --view SCENE`: the word after it is the scene where no other word is.
            ->transform([scene](const std::string& word) {
                if (word.empty() || scene->count() > 0) return word;
                scene->add_result(word);
                return std::string();
            })
            ->description(view->get_description() +
                          "; alone, without a camera: show the solution in the browser while it "
                          "grows, as exitance view does");
        walking_.add_no_open(command, "--view");
#endif
        reporting_.add_to(command);
        command.footer(
            "Examples:\n"
            "  exitance solve scenes/cornell.toml -o cornell.glb\n"
            "  exitance solve scenes/cornell.toml -o draft.glb --error 0.1 --time 10\n"
            "  exitance solve scenes/cornell.toml -o front.glb --view front\n"
            "  exitance solve scenes/cornell.toml -o cornell.glb --resume draft.glb --error 0.01\n"
            "\n"
            "Ctrl-C stops cleanly and writes what is solved. A project's [solve] table sets the\n"
            "same options by the same names; the command line wins.");
    }

    void run() {
        if (output_ && compare_)
            throw Error(Fault::wrong_use, "--compare prints a table and writes no --output");
        if (resume_ && compare_)
            throw Error(Fault::wrong_use, "--compare begins every solve anew: no --resume");
        if (output_)
            require_output(*output_, scene_, {".glb"});
        else if (reporting_.log != "csv" && !compare_)
            throw Error(Fault::wrong_use, "--output is required");
        reading_.apply({});
        require_scene(scene_);
        const Scene scene = read_scene(scene_, read_options_);
        if (!reporting_.quiet) print_findings(scene);
        given_.apply(scene.settings);
        const bool live = options_.view && options_.view->empty();
        if (live) options_.view = setting_of(scene, "view");

        std::optional<Resumption> resumption;
        if (resume_) {
            require_resumable(options_);
            resumption.emplace(Resumption{read_solution(*resume_)});
        }
        Resumption* const resumed = resumption ? &*resumption : nullptr;

        if (!reporting_.quiet && !compare_) print_choice(options_);
        const bool told = !reporting_.quiet && reporting_.log != "json";
        const Interrupt interrupt(!told ? Replies{} : live ? live_replies : replies);
        if (compare_) {
            fmt::print("{}", compare_solvers(scene, options_, interrupt.cancel()));
            return;
        }
#ifdef EXITANCE_VIEWER
        if (!walking_.open && !live)
            throw Error(Fault::wrong_use, "--no-open goes with --view alone, without a camera");
        if (live) return solve_and_view(scene, resumed, interrupt.cancel());
#else
        if (live) throw Error(Fault::wrong_use, "--view: expected the name of a camera");
#endif
        const Stopwatch watch;
        const Solution solution =
            light(scene, options_, make_observer(reporting_), &interrupt.cancel(), {}, resumed);
        clear_bar(reporting_);
        if (output_) write_solution(solution, *output_);
        report(solution, watch, interrupt.cancel().requested(), resumed);
    }

  private:
    SolveOptions options_;
    GivenOptions given_;
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path scene_;
    std::optional<std::filesystem::path> output_, resume_;
    bool compare_ = false;
    Reporting reporting_;

    static std::optional<std::string> setting_of(const Scene& scene, const std::string& name) {
        std::optional<std::string> out;
        for (const Setting& setting : scene.settings)
            if (setting.name == name) out = setting.value;
        return out;
    }

    void report(const Solution& solution, const Stopwatch& watch, bool stopped,
                const Resumption* resumed) const {
        if (reporting_.quiet) return;
        // A table on stdout stays one.
        std::FILE* said = reporting_.log == "csv" ? stderr : stdout;
        if (stopped) fmt::print(said, "{}\n", stopped_early);
        if (resumed && resumed->outcome != Resumption::Outcome::improved)
            fmt::print(said, "{} {}\n", resume_->string(),
                       resumed->outcome == Resumption::Outcome::sufficient
                           ? "has the error asked for: nothing is left to do"
                           : "is kept: nothing better was found");
        const Aim aim{options_.error, resumed ? resumed->ended : solution.ended};
        fmt::print(said, "{}",
                   summary(solution, output_.value_or("not written"), watch.seconds(), aim));
    }

#ifdef EXITANCE_VIEWER
    WalkthroughOptions walking_;

    void solve_and_view(const Scene& scene, Resumption* resumed, const Cancel& interrupt) {
        if (!output_) throw Error(Fault::wrong_use, "--view needs --output");
        if (reporting_.log == "csv")
            throw Error(Fault::wrong_use, "--view prints an address, --log csv a table");
        walking_.solve_to_end = true;
        Walkthrough walk(walking_, reporting_);
        const Stopwatch watch;
        const Lit lit =
            walk.light(scene, options_, *output_, interrupt, {.ambient = true}, resumed);
        report(lit.solution, watch, lit.stopped, resumed);
        std::fflush(stdout);
        walk.stay_if_watched(interrupt);
    }
#endif
};

}  // namespace

void add_solve(CLI::App& app) {
    CLI::App& command =
        *app.add_subcommand("solve", "light a scene: a scene file goes in, a solution comes out");
    const auto solve = std::make_shared<SolveCommand>(command);
    command.callback([solve] { solve->run(); });
}

}  // namespace exitance::cli
