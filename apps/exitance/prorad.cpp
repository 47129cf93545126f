// SPDX-License-Identifier: Apache-2.0
// exitance prorad: the command line of the original system, on the engine of `solve`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "commands.h"
#include "exitance/pipeline.h"
#include "exitance/render/render.h"
#include "exitance/scene/formats/afit.h"
#include "exitance/solution/file.h"
#include "exitance/solution/surfaces.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "summary.h"
#ifdef EXITANCE_VIEWER
#include "temporary_folder.h"
#include "walkthrough.h"
#endif

namespace exitance::cli {

namespace {

class ProradCommand {
  public:
    explicit ProradCommand(CLI::App& command) : given_(command, "Solving", describe(options_)) {
        command.add_option("-g", geometry_, "geometry: points, polygons, attributes")
            ->type_name("geom")
            ->required();
        command.add_option("-d", display_, "display: camera, resolution, ambient, threshold")
            ->type_name("display")
            ->required();
        command.add_option("-o", output_, "write the solution, a binary glTF")
            ->type_name("outfile");
        CLI::Option* wireframe =
            command.add_flag("-w", picture_.wireframe, "draw the wireframe of the elements");
        command.add_flag("-n", picture_.normals, "draw normals, with -w")->needs(wireframe);
        command.add_flag("-t", no_occlusion_,
                         "no occlusion test: everything sees everything, as --no-occlusion");
        CLI::Option* pictures = command.add_option("--pictures", every_,
                                                   "a numbered picture after every so many shots");
        pictures->type_name("shots")
            ->check(CLI::PositiveNumber.description(""))
            ->expected(0, 1)
            ->default_str("16");
#ifdef EXITANCE_VIEWER
        command.add_flag("-s", show_, "show while solving: a walk through it in the browser")
            ->excludes(pictures);
        walking_.add_no_open(command, "-s");
#endif
        reporting_.add_to(command);
        command.footer(
            "The picture is outfile.png, or named after the geometry in the current folder;\n"
            "with --pictures also …-0001.png and so on, the last one at the end. The display "
            "file's\n"
            "threshold ends the work: 1000 × energy of the next patch to shoot / emitted energy.\n"
            "\n"
            "Example:\n"
            "  exitance prorad -g scenes/cornell.geom -d scenes/cornell.display -o cornell.glb");
    }

    void run() {
        const std::filesystem::path picture = picture_name();
        if (output_ == picture)
            throw Error(Fault::wrong_use, "-o: '" + picture.string() +
                                              "' is the picture's name, expected another ending");
        if (output_) require_output(*output_, geometry_, {});
        require_output(picture, geometry_, {});
        const AfitDisplay display = read_afit_display(display_);
        Scene scene = read_afit_geometry(geometry_);
        scene.cameras.push_back(camera_of(display));
        if (!reporting_.quiet) print_findings(scene);

        const Interrupt interrupt;
        const Stopwatch watch;
        int number = 0;
        Snapshots snapshots{.every = every_, .ambient = display.ambient.value_or(false)};
        std::optional<Solution> latest;
        snapshots.take = [&](Solution so_far) {
            if (every_) draw(so_far, display, numbered(picture, ++number));
            latest = std::move(so_far);
        };
        apply(display);
        if (!reporting_.quiet) print_choice(options_);
        const auto finish = [&](const Solution& solution, bool stopped) {
            draw(*latest, display, picture);
            if (output_) write_solution(solution, *output_);
            if (reporting_.quiet) return;
            if (stopped) std::puts(stopped_early);
            const std::string said = summary(solution, output_.value_or(picture), watch.seconds(),
                                             options_.next_shot ? std::nullopt : aim_of(solution));
            std::fputs(said.c_str(), stdout);
            std::fflush(stdout);
        };
#ifdef EXITANCE_VIEWER
        if (show_) {
            walking_.solve_to_end = true;
            const TemporaryFolder folder;
            Walkthrough walk(walking_, reporting_);
            const Lit lit = walk.light(scene, options_, folder.path() / "solution.glb",
                                       interrupt.cancel(), snapshots);
            finish(lit.solution, lit.stopped);
            walk.stay_if_watched(interrupt.cancel());
            return;
        }
#endif
        const Solution solution =
            light(scene, options_, make_observer(reporting_), &interrupt.cancel(), snapshots);
        clear_bar(reporting_);
        finish(solution, interrupt.cancel().requested());
    }

  private:
    SolveOptions options_;
    GivenOptions given_;
    std::filesystem::path geometry_, display_;
    std::optional<std::filesystem::path> output_;
    std::optional<std::uint64_t> every_;
    bool no_occlusion_ = false;
    RenderOptions picture_;
    Reporting reporting_;
#ifdef EXITANCE_VIEWER
    bool show_ = false;
    WalkthroughOptions walking_;
#endif

    std::filesystem::path picture_name() const {
        return output_.value_or(geometry_.filename()).replace_extension(".png");
    }

    static std::filesystem::path numbered(std::filesystem::path picture, int number) {
        return picture.replace_filename(
            fmt::format("{}-{:04}.png", picture.stem().string(), number));
    }

    /// The display file first, then the command line.
    void apply(const AfitDisplay& display) {
        if (display.threshold.value_or(0) > 0) {
            options_.next_shot = std::min(1.0, *display.threshold / 1000);
            options_.unshot = 0;  // the threshold alone decides
        }
        given_.apply({});
        // What the original does: progressive refinement.
        if (!options_.solver && !goes_with_transport(options_)) options_.solver = "shooting";
        if (no_occlusion_) options_.occlusion = false;
    }

    void draw(const Solution& solution, const AfitDisplay& display,
              const std::filesystem::path& file) const {
        const Surfaces surfaces(solution, Backs::open);
        write_image(
            render_display(surfaces, camera_of(display), {display.width, display.height}, picture_),
            file);
    }
};

}  // namespace

void add_prorad(CLI::App& app) {
    CLI::App& command = *app.add_subcommand("prorad", "the original command line, on this engine");
    const auto prorad = std::make_shared<ProradCommand>(command);
    command.callback([prorad] { prorad->run(); });
}

}  // namespace exitance::cli
