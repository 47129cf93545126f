// SPDX-License-Identifier: Apache-2.0
// exitance convert: a scene in another format.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "exitance/scene/formats/write_scene.h"
#include "exitance/scene/read.h"
#include "options_cli.h"
#include "output_path.h"
#include "summary.h"

namespace exitance::cli {

namespace {

class ConvertCommand {
  public:
    explicit ConvertCommand(CLI::App& command)
        : reading_(command, "Reading a scene", describe(read_options_)) {
        command.add_option("in", input_, "a scene in any format that solve reads")->required();
        command
            .add_option("out", output_,
                        "the same as glTF (.glb, .gltf), OBJ (.obj and .mtl), AFIT geometry "
                        "(.geom and .display), MGF (.mgf) or Radiance (.rad)")
            ->required();
        command.footer(
            "What the format cannot carry is listed on stderr, one line each, after what the\n"
            "reader had to say.\n"
            "\n"
            "Example:\n"
            "  exitance convert scenes/cornell.toml cornell.mgf");
    }

    void run() {
        require_output(output_, input_, writable_endings());
        reading_.apply({});
        require_scene(input_);
        const Scene scene = read_scene(input_, read_options_);
        print_findings(scene);
        for (const std::string& lost : write_scene(scene, output_))
            std::fprintf(stderr, "lost: %s\n", lost.c_str());
    }

  private:
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path input_, output_;
};

}  // namespace

void add_convert(CLI::App& app) {
    CLI::App& command = *app.add_subcommand("convert", "write a scene in another format");
    const auto convert = std::make_shared<ConvertCommand>(command);
    command.callback([convert] { convert->run(); });
}

}  // namespace exitance::cli
