// SPDX-License-Identifier: Apache-2.0
// exitance info: what a file holds, in words.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "exitance/scene/read.h"
#include "exitance/scene/validate.h"
#include "exitance/solution/file.h"
#include "options_cli.h"
#include "scene_report.h"

namespace exitance::cli {

namespace {

class InfoCommand {
  public:
    explicit InfoCommand(CLI::App& command)
        : reading_(command, "Reading a scene", describe(read_options_)) {
        command
            .add_option(
                "file", file_,
                "a scene (.toml, .glb, .gltf, .mgf, .rad, .geom) or a solution (.glb that solve "
                "wrote)")
            ->required();
        command.add_flag("--json", json_, "the same as one JSON object");
        command.footer(
            "Lengths are in metres, areas in square metres; a reflectance is the share of light\n"
            "that a surface sends back, its first number weighted as the eye weighs red, green\n"
            "and blue. Problems found do not change the exit code.\n"
            "\n"
            "Example:\n"
            "  exitance info scenes/cornell.toml");
    }

    void run() {
        reading_.apply({});
        if (is_solution(file_)) {
            const SolutionReport report(read_solution(file_), file_);
            std::fputs((json_ ? report.json() : report.text()).c_str(), stdout);
        } else {
            const Scene scene = read_scene(file_, read_options_);
            const SceneReport report(scene, validate(scene), file_);
            std::fputs((json_ ? report.json() : report.text()).c_str(), stdout);
        }
    }

  private:
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path file_;
    bool json_ = false;
};

}  // namespace

void add_info(CLI::App& app) {
    CLI::App& command = *app.add_subcommand(
        "info", "what a file holds: sizes, materials, lamps, cameras, problems found");
    const auto info = std::make_shared<InfoCommand>(command);
    command.callback([info] { info->run(); });
}

}  // namespace exitance::cli
