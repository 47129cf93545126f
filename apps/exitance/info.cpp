// SPDX-License-Identifier: Apache-2.0
// exitance info: what a file holds, in words.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>

#include "commands.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/read.h"
#include "exitance/scene/validate.h"
#include "exitance/solution/file.h"
#include "lamp_report.h"
#include "options_cli.h"
#include "polar_diagram.h"
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
                "a scene (.toml, .glb, .gltf, .mgf, .rad, .geom, .vs3, .obj, .ply, .stl, .fbx, "
                ".dae, .3ds, .ifc), a solution (.glb that solve "
                "wrote) or a luminaire's photometry (.ies, .ldt)")
            ->required();
        command
            .add_option("-o,--output", diagram_,
                        "of a luminaire: write its polar intensity diagram (.svg)")
            ->type_name("file.svg");
        command.add_flag("--json", json_, "the same as one JSON object");
        command.footer(
            "Lengths are in metres, areas in square metres; a reflectance is the share of light\n"
            "that a surface sends back, its first number weighted as the eye weighs red, green\n"
            "and blue. Problems found do not change the exit code.\n"
            "\n"
            "Example:\n"
            "  exitance info scenes/cornell.toml\n"
            "  exitance info downlight.ldt -o downlight.svg");
    }

    void run() {
        reading_.apply({});
        if (is_lamp_file(file_)) return lamp();
        if (diagram_)
            throw Error(Fault::wrong_use,
                        "--output draws the intensities of a luminaire, which needs an .ies or "
                        ".ldt file");
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
    void lamp() const {
        if (diagram_ && lower_extension(*diagram_) != ".svg")
            throw Error(Fault::wrong_use,
                        "diagrams are written as .svg, found '" + diagram_->string() + "'");
        LampFile lamp = read_lamp_file(file_, 1, read_options_);
        if (diagram_) {
            const std::string& name = lamp.photometry.name;
            const std::string svg = polar_diagram(
                lamp.photometry, name.empty() ? as_utf8(file_.stem().string()) : name);
            write_atomically(*diagram_, [&](std::ostream& out) { out << svg; });
        }
        const LampReport report(std::move(lamp), file_);
        std::fputs((json_ ? report.json() : report.text()).c_str(), stdout);
    }

    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path file_;
    std::optional<std::filesystem::path> diagram_;
    bool json_ = false;
};

}  // namespace

void add_info(CLI::App& app) {
    CLI::App& command = *app.add_subcommand("info",
                                            "what a file holds: sizes, materials, lamps, cameras, "
                                            "problems; the diagram of a luminaire");
    const auto info = std::make_shared<InfoCommand>(command);
    command.callback([info] { info->run(); });
}

}  // namespace exitance::cli
