// SPDX-License-Identifier: Apache-2.0
// exitance form-factors: a scene goes in, the matrix of its form factors comes out.
#include "exitance/formfactor/form_factors.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "exitance/formfactor/files/write_form_factors.h"
#include "exitance/formfactor/interchange.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/read.h"
#include "form_factor_report.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "summary.h"
#include "view3d_settings.h"

namespace exitance::cli {

namespace {

struct OutputOptions {
    bool interchange = false, view3d_binary = false, list = false;
    std::optional<double> row{}, col{};
};

Options describe(OutputOptions& o) {
    return {
        {"interchange", &o.interchange,
         "write total interchange factors (script-F), all reflections between the surfaces' "
         "emissivities included"},
        {"view3d-binary", &o.view3d_binary, "write .vf in View3D's binary form"},
        {"list", &o.list, "print every factor that is not zero"},
        {"row", &o.row, "list this row only, from 1", "", 1, 4e9},
        {"col", &o.col, "list this column only, from 1", "", 1, 4e9},
    };
}

Options all_options(FormFactorOptions& factors, OutputOptions& output) {
    Options options = describe(factors);
    for (Option& option : describe(output)) options.push_back(std::move(option));
    return options;
}

class FormFactorsCommand {
  public:
    explicit FormFactorsCommand(CLI::App& command)
        : given_(command, "Form factors", all_options(options_, output_options_)),
          reading_(command, "Reading a scene", describe(read_options_)) {
        command
            .add_option("scene", scene_,
                        "the enclosure: .vs3 as View3D reads it, or any scene that solve reads")
            ->required();
        command
            .add_option("--output,-o", output_,
                        "the matrix: .csv plain rows, .mtx Matrix Market, .npz SciPy, .vf View3D, "
                        ".dat Elmer; with --format openfoam a folder")
            ->type_name("file")
            ->required();
        std::vector<std::string> formats;
        for (const FormFactorFormat& format : form_factor_formats())
            formats.emplace_back(format.name);
        command.add_option("--format", format_, "what is written, where the name does not say")
            ->type_name(fmt::format("{}", fmt::join(formats, "|")));
        reporting_.add_to(command);
        command.footer(
            "Examples:\n"
            "  exitance form-factors scenes/two_boxes.vs3 -o F.vf\n"
            "  exitance form-factors scenes/cornell.toml -o F.npz --by surface\n"
            "  exitance form-factors scenes/cornell.toml -o F.csv --method hemicube --accuracy "
            "1e-3 \\\n"
            "    --enforce both\n"
            "\n"
            "The C lines of a .vs3 file set what they name (eps, encl, emit, out, list, row, "
            "col);\n"
            "the command line wins. Ctrl-C stops; nothing is written then.");
    }

    void run() {
        const FormFactorFormat& format = find_form_factor_format(format_, output_);
        require_place(format);
        reading_.apply({});
        const Scene scene = read_scene(scene_, read_options_);
        if (!reporting_.quiet) print_findings(scene);
        given_.apply(view3d_settings(scene, scene_));

        const Interrupt interrupt;
        const Stopwatch watch;
        const FormFactors made =
            form_factors(scene, options_, make_observer(reporting_), &interrupt.cancel());
        clear_bar(reporting_);
        require_listed(made);
        std::optional<FormFactorMatrix> total;
        if (output_options_.interchange)
            total = interchange_factors(made.F, made.enclosure.surfaces);
        const FormFactorMatrix& asked = total ? *total : made.F;
        write_form_factors(output_, format,
                           {asked, made.enclosure.surfaces, EXITANCE_VERSION,
                            options_.enforce == "both" || options_.enforce == "closure",
                            output_options_.interchange, output_options_.view3d_binary});
        if (reporting_.quiet) return;
        std::fputs(form_factor_report(made, options_).c_str(), stdout);
        if (output_options_.list || output_options_.row || output_options_.col)
            std::fputs(factor_list(asked, made.names(), listed(output_options_.row),
                                   listed(output_options_.col))
                           .c_str(),
                       stdout);
        fmt::print("{}: {}, after {:.2f} s\n", output_.string(), format.what, watch.seconds());
    }

  private:
    void require_place(const FormFactorFormat& format) const {
        if (format.write) return require_output(output_, scene_, {});
        if (!std::filesystem::is_directory(output_))
            throw Error(
                Fault::could_not_finish,
                fmt::format("cannot write into {}: there is no such folder", output_.string()));
        check_writable(output_ / "F");
    }

    static std::optional<std::size_t> listed(const std::optional<double>& number) {
        if (!number) return std::nullopt;
        return static_cast<std::size_t>(*number);
    }

    void require_listed(const FormFactors& made) const {
        for (const auto& number : {output_options_.row, output_options_.col})
            if (number && *number > static_cast<double>(made.F.rows()))
                throw Error(Fault::wrong_use,
                            fmt::format("--row, --col: {} is too many, there are {} surfaces",
                                        *number, made.F.rows()));
    }

    FormFactorOptions options_;
    OutputOptions output_options_;
    GivenOptions given_;
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path scene_, output_;
    std::string format_;
    Reporting reporting_;
};

}  // namespace

void add_form_factors(CLI::App& app) {
    CLI::App& command = *app.add_subcommand(
        "form-factors", "form factors between the surfaces of a scene: the matrix F as a file");
    const auto form_factors = std::make_shared<FormFactorsCommand>(command);
    command.callback([form_factors] { form_factors->run(); });
}

}  // namespace exitance::cli
