// SPDX-License-Identifier: Apache-2.0
// exitance probe: irradiance at points, from a solution.
#include "exitance/solution/probe.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "commands.h"
#include "csv_cells.h"
#include "exitance/run/atomic_file.h"
#include "exitance/solution/file.h"
#include "exitance/solution/light_scenes.h"
#include "options_cli.h"
#include "output_path.h"
#include "points_csv.h"

namespace exitance::cli {

namespace {

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

class ProbeCommand {
  public:
    explicit ProbeCommand(CLI::App& command) : given_(command, "Probing", describe(options_)) {
        command.add_option("solution", solution_, "what solve wrote")
            ->type_name("file.glb")
            ->required();
        command
            .add_option("--points", points_,
                        "table with the columns x,y,z,nx,ny,nz [m]; - = standard input")
            ->type_name("file.csv")
            ->required();
        command
            .add_option("--output,-o", output_,
                        "the same table with E_r,E_g,E_b (one per band) appended; - = standard "
                        "output")
            ->type_name("file.csv")
            ->required();
        command.add_flag("--groups", per_group_,
                         "also E_<group>_<band> of each light group by itself, at weight 1");
        command.add_option("--scene", scene_, "weigh the groups as this scene of the project says")
            ->type_name("name");
        command.footer(
            "Irradiance is in the unit of the solution, on the side of the normal, summed over "
            "the\n"
            "light groups with their weights. Where interpolate finds no surface that faces along\n"
            "the normal, the values are nan.\n"
            "\n"
            "Example:\n"
            "  exitance probe cornell.glb --points desk.csv -o desk_lux.csv --method gather");
    }

    void run() {
        given_.apply({});
        if (output_ != "-") {
            require_output(output_, points_, {".csv"});
            require_output(output_, solution_, {".csv"});
        }
        Solution solution = read_solution(solution_);
        if (scene_) apply_light_scene(solution, *scene_);
        const PointTable table = read_table();
        const std::vector<double> E = probe(solution, table.points, options_);
        const std::vector<std::string> names = column_names(solution);
        const std::vector<double> values = summed(solution, E, table.points.size());
        if (output_ == "-") {
            write_points(std::cout, table, names, values);
            if (!std::cout.flush())
                throw Error(Fault::could_not_finish, "cannot write to standard output");
        } else {
            write_atomically(output_,
                             [&](std::ostream& out) { write_points(out, table, names, values); });
        }
        std::size_t missing = 0;
        for (std::size_t i = 0; i < table.points.size(); ++i)
            missing += std::isnan(values[i * names.size()]) ? 1 : 0;
        if (missing)
            fmt::print(stderr,
                       "exitance: no surface near {} of {} points that faces along the normal: "
                       "nan; --method gather works in free space\n",
                       missing, table.points.size());
    }

  private:
    ProbeOptions options_;
    GivenOptions given_;
    std::filesystem::path solution_, points_, output_;
    bool per_group_ = false;
    std::optional<std::string> scene_;

    PointTable read_table() const {
        if (points_ == "-") return read_points(std::cin, "standard input");
        std::error_code unknown;
        std::ifstream in(points_);
        if (!in || std::filesystem::is_directory(points_, unknown))
            throw Error(Place{points_.string()}, "cannot be read, expected a table of points");
        return read_points(in, points_.string());
    }

    std::vector<std::string> column_names(const Solution& solution) const {
        std::vector<std::string> names;
        for (const std::string& band : solution.bands)
            names.push_back(csv_cell("E_" + lower(band)));
        if (per_group_)
            for (const LightGroup& group : solution.groups)
                for (const std::string& band : solution.bands)
                    names.push_back(csv_cell("E_" + group.name + "_" + lower(band)));
        return names;
    }

    /// Per point: the weighted sum of the groups per band; then, if asked for, each group.
    std::vector<double> summed(const Solution& solution, const std::vector<double>& E,
                               std::size_t points) const {
        const std::size_t bands = solution.bands.size(), columns = solution.columns();
        std::vector<double> out;
        for (std::size_t i = 0; i < points; ++i) {
            for (std::size_t b = 0; b < bands; ++b) {
                double sum = 0;
                for (std::size_t g = 0; g < solution.groups.size(); ++g)
                    sum += solution.groups[g].weight * E[i * columns + g * bands + b];
                out.push_back(sum);
            }
            if (per_group_)
                out.insert(out.end(), E.begin() + std::ptrdiff_t(i * columns),
                           E.begin() + std::ptrdiff_t((i + 1) * columns));
        }
        return out;
    }
};

}  // namespace

void add_probe(CLI::App& app) {
    CLI::App& command = *app.add_subcommand("probe", "irradiance at points, from a solution");
    const auto probing = std::make_shared<ProbeCommand>(command);
    command.callback([probing] { probing->run(); });
}

}  // namespace exitance::cli
