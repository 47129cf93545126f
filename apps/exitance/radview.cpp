// SPDX-License-Identifier: Apache-2.0
// exitance radview: the walkthrough by the command line of the original system.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "commands.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "interrupt.h"
#include "options_cli.h"
#include "summary.h"
#include "temporary_folder.h"
#include "walkthrough.h"

namespace exitance::cli {

namespace {

class RadviewCommand {
  public:
    explicit RadviewCommand(CLI::App& command) {
        command.add_option("file", input_, "a solution, or a scene that is lit while one watches")
            ->type_name("file")
            ->required();
        command.add_option("up-axis", axis_, "which points up: y, -y, z or -z")
            ->type_name("axis")
            ->check(CLI::Validator(
                [](const std::string& given) {
                    return given == "y" || given == "z"
                               ? ""
                               : "found '" + given + "', expected y, -y, z or -z";
                },
                ""))
            ->default_str("as the file says");
        CLI::Option* down = command.add_flag_callback(
            "-y", [this] { axis_ = "-y"; }, "-y is up");
        command
            .add_flag_callback(
                "-z", [this] { axis_ = "-z"; }, "-z is up")
            ->excludes(down)
            ->excludes("up-axis");
        down->excludes("up-axis");
        walking_.add_no_open(command);
        reporting_.add_to(command);
        command.footer(
            "The page and its keys are those of exitance view. F1, F2: help; drag, arrows: "
            "azimuth\n"
            "and elevation; z, x: zoom; a, s: along and against the line of sight; right click:\n"
            "manual or automatic; r: reset; Esc Esc: end.\n"
            "\n"
            "Examples:\n"
            "  exitance radview cornell.glb\n"
            "  exitance radview scenes/cornell.geom z");
    }

    void run() const {
        const Interrupt interrupt;
        const TemporaryFolder folder;
        const std::filesystem::path shown = folder.path() / "solution.glb";
        if (is_solution(input_)) {
            Solution solution = read_solution(input_);
            if (axis_) {
                solution.up = up();
                write_solution(solution, shown);
            }
            Walkthrough(walking_, reporting_, axis_ ? shown : input_).stay(interrupt.cancel());
            return;
        }
        Scene scene = read_scene(input_);
        if (!reporting_.quiet) print_findings(scene), print_lit_anew(input_);
        if (axis_) scene.up = up();
        SolveOptions options;
        apply_settings(scene.settings, describe(options));
        Walkthrough walk(walking_, reporting_);
        walk.light(scene, options, shown, interrupt.cancel(), {.ambient = true});
        walk.stay(interrupt.cancel());
    }

  private:
    std::filesystem::path input_;
    std::optional<std::string> axis_;
    WalkthroughOptions walking_;
    Reporting reporting_;

    Vec3 up() const {
        const double sign = axis_->front() == '-' ? -1 : 1;
        return axis_->back() == 'y' ? Vec3{0, sign, 0} : Vec3{0, 0, sign};
    }
};

}  // namespace

void add_radview(CLI::App& app) {
    CLI::App& command =
        *app.add_subcommand("radview", "the original walkthrough's command line, in the browser");
    const auto radview = std::make_shared<RadviewCommand>(command);
    command.callback([radview] { radview->run(); });
}

}  // namespace exitance::cli
