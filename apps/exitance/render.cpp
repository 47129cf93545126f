// SPDX-License-Identifier: Apache-2.0
// exitance render: a picture of a solution, or of a scene that is lit first.
#include "exitance/render/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "exitance/pipeline.h"
#include "exitance/render/automatic_view.h"
#include "exitance/run/error.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "exitance/solution/light_scenes.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "summary.h"

namespace exitance::cli {

namespace {

Vec3 vector_of(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

class RenderCommand {
  public:
    explicit RenderCommand(CLI::App& command)
        : given_(command, "Picture", describe(options_)),
          reading_(command, "Reading a scene", describe(read_options_)) {
        command.add_option("input", input_, "a solution, or a scene that is solved first")
            ->type_name("file")
            ->required();
        command
            .add_option("--output,-o", output_,
                        "the picture: .png as a screen shows it, .exr or .hdr with linear radiance")
            ->type_name("file")
            ->required();
        add_camera(command);
        command
            .add_option("--group", weights_,
                        "weight of a light group, instead of the solution's; may be repeated")
            ->type_name("name=weight")
            ->allow_extra_args(false)
            ->group("Picture");
        command.add_option("--scene", scene_, "weigh the groups as this scene of the project says")
            ->type_name("name")
            ->group("Picture");
        command
            .add_option("--range", range_,
                        "values at the ends of the false colours (default: 0 and what 99 % of the "
                        "picture stays below)")
            ->type_name("min max")
            ->expected(2)
            ->group("Picture");
        reporting_.add_to(command);
        command.footer(
            "Without a camera the first one of the scene is taken, else one is placed.\n"
            "\n"
            "Examples:\n"
            "  exitance render cornell.glb -o cornell.png\n"
            "  exitance render office.glb -o lux.png --false-colour irradiance --range 0 1000\n"
            "  exitance render office.glb -o evening.exr --group daylight=0 --eye 1 1.6 4 "
            "--look-at 3 1 0");
    }

    void run() {
        given_.apply({});
        reading_.apply({});
        options_.group_weights = parsed_weights();
        if (range_.size() == 2) options_.range = {range_[0], range_[1]};
        require_output(output_, input_, {".png", ".exr", ".hdr"});
        const bool on_screen = image_format(output_) == ImageFormat::png;
        if (!on_screen && (options_.false_colour || options_.wireframe || options_.normals))
            throw Error(Fault::wrong_use,
                        "--false-colour, --wireframe and --normals need a .png: " +
                            output_.extension().string() + " carries radiance");
        if (options_.range && !options_.false_colour)
            throw Error(Fault::wrong_use, "--range needs --false-colour");
        if (options_.size) parse_size(*options_.size);

        Solution solution =
            is_solution(input_) ? read_solution(input_) : lit(read_scene(input_, read_options_));
        if (scene_) apply_light_scene(solution, *scene_);
        const Surfaces surfaces(solution, Backs::open);
        const Camera camera = chosen_camera(surfaces);
        const ImageSize size = size_of_picture(options_, camera);
        write_image(on_screen ? render_display(surfaces, camera, size, options_)
                              : render_radiance(surfaces, camera, size, options_),
                    output_);
    }

  private:
    RenderOptions options_;
    GivenOptions given_;
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path input_, output_;
    Reporting reporting_;
    std::optional<std::string> camera_, scene_;
    std::vector<double> eye_, look_at_, up_, range_;
    std::optional<double> fov_;
    std::vector<std::string> weights_;

    void add_camera(CLI::App& command) {
        auto* name = command.add_option("--camera", camera_, "a camera of the scene, by name")
                         ->type_name("name")
                         ->group("Camera");
        const auto place = [&](const char* flag, std::vector<double>& value, const char* what) {
            return command.add_option(flag, value, what)
                ->type_name("x y z")
                ->expected(3)
                ->delimiter(',')
                ->group("Camera");
        };
        auto* eye = place("--eye", eye_, "where the camera stands [m]")->excludes(name);
        auto* look_at = place("--look-at", look_at_, "the point it looks at [m]")->excludes(name);
        eye->needs(look_at);
        look_at->needs(eye);
        place("--up", up_, "direction that is up in the picture (default: as the scene has it)")
            ->excludes(name);
        command
            .add_option("--fov", fov_, "vertical field of view (default: the camera's, else 45)")
            ->type_name("degrees")
            ->group("Camera");
    }

    std::map<std::string, double> parsed_weights() const {
        std::map<std::string, double> out;
        for (const std::string& text : weights_) {
            const auto sign = text.rfind('=');
            double weight = 0;
            const char* end = text.data() + text.size();
            const char* number = text.data() + std::min(text.size(), sign + 1);
            const auto [rest, failure] = std::from_chars(number, end, weight);
            if (sign == std::string::npos || failure != std::errc{} || rest != end ||
                !std::isfinite(weight))
                throw Error(Fault::wrong_use,
                            "--group: '" + text + "' is not allowed, expected name=weight");
            out[text.substr(0, sign)] = weight;
        }
        return out;
    }

    Solution lit(const Scene& scene) const {
        if (!reporting_.quiet) print_findings(scene);
        SolveOptions options;
        const Options declared = describe(options);
        for (const Setting& setting : scene.settings) {
            try {
                find_option(declared, setting.name).set(setting.value);
            } catch (const Error& error) {
                throw Error(setting.place, error.what());
            }
        }
        const Interrupt interrupt;
        Solution solution = light(scene, options, make_observer(reporting_), &interrupt.cancel());
        clear_bar(reporting_);
        return solution;
    }

    Camera chosen_camera(const Surfaces& surfaces) const {
        const std::vector<Camera>& cameras = surfaces.solution().cameras;
        Camera camera;
        if (camera_) {
            camera = named_camera(cameras, *camera_);
        } else if (!eye_.empty()) {
            camera.eye = vector_of(eye_);
            camera.look_at = vector_of(look_at_);
            camera.up = surfaces.solution().up;
        } else if (!cameras.empty()) {
            camera = cameras.front();
        } else {
            camera =
                automatic_view(surfaces, up_.empty() ? surfaces.solution().up : vector_of(up_));
        }
        if (!up_.empty()) camera.up = vector_of(up_);
        if (fov_) camera.fov_y = *fov_;
        return camera;
    }

    static Camera named_camera(const std::vector<Camera>& cameras, const std::string& name) {
        std::vector<std::string> names;
        for (const Camera& camera : cameras) {
            if (camera.name == name) return camera;
            names.push_back(camera.name);
        }
        throw Error(Fault::wrong_use,
                    names.empty()
                        ? "--camera: the scene has none; use --eye and --look-at"
                        : fmt::format("--camera: there is no '{}'{}; the cameras are {}", name,
                                      suggestion(name, names), fmt::join(names, ", ")));
    }
};

}  // namespace

void add_render(CLI::App& app) {
    CLI::App& command =
        *app.add_subcommand("render", "a picture of a solution, as a camera sees it");
    const auto rendering = std::make_shared<RenderCommand>(command);
    command.callback([rendering] { rendering->run(); });
}

}  // namespace exitance::cli
