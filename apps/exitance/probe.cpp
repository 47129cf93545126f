// SPDX-License-Identifier: Apache-2.0
// exitance probe: irradiance at points, from a solution.
#include "exitance/solution/probe.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>

#include "commands.h"
#include "csv_cells.h"
#include "exitance/run/atomic_file.h"
#include "exitance/solution/file.h"
#include "exitance/solution/light_scenes.h"
#include "human_number.h"
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
        auto* points =
            command
                .add_option("--points", points_,
                            "table with the columns x,y,z,nx,ny,nz [m]; - = standard input")
                ->type_name("file.csv");
        command
            .add_option("--grid", grid_,
                        "instead of points, the sensors of a grid of the project; tells their "
                        "least, mean and largest value on stderr")
            ->type_name("name")
            ->excludes(points);
        command
            .add_option("--output,-o", output_,
                        "the same table with E_r,E_g,E_b (one per band) appended; - = standard "
                        "output; required with --points")
            ->type_name("file.csv");
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
            "Examples:\n"
            "  exitance probe cornell.glb --points desk.csv -o desk_lux.csv --method gather\n"
            "  exitance probe office.glb --grid desk --method gather");
    }

    void run() {
        given_.apply({});
        if (points_.empty() && !grid_)
            throw Error(Fault::wrong_use, "expected --points or --grid: where to probe");
        if (!points_.empty() && output_.empty())
            throw Error(Fault::wrong_use, "--output is required with --points");
        if (!output_.empty() && output_ != "-") {
            if (!points_.empty()) require_output(output_, points_, {".csv"});
            require_output(output_, solution_, {".csv"});
        }
        Solution solution = read_solution(solution_);
        if (scene_) apply_light_scene(solution, *scene_);
        const PointTable table = grid_ ? points_of(chosen_grid(solution)) : read_table();
        const std::vector<double> E = probe(solution, table.points, options_);
        const std::vector<std::string> names = column_names(solution);
        const std::vector<double> values = summed(solution, E, table.points.size());
        if (output_ == "-") {
            write_points(std::cout, table, names, values);
            if (!std::cout.flush())
                throw Error(Fault::could_not_finish, "cannot write to standard output");
        } else if (!output_.empty()) {
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
        if (grid_) tell_grid(solution, values, names.size());
    }

  private:
    ProbeOptions options_;
    GivenOptions given_;
    std::filesystem::path solution_, points_, output_;
    bool per_group_ = false;
    std::optional<std::string> scene_, grid_;

    const SensorGrid& chosen_grid(const Solution& solution) const {
        std::vector<std::string> names;
        for (const SensorGrid& grid : solution.grids) {
            if (grid.name == *grid_) return grid;
            names.push_back(grid.name);
        }
        throw Error(Fault::wrong_use, fmt::format("--grid: there is no grid '{}'{}", *grid_,
                                                  names.empty() ? "; the solution has none"
                                                                : suggestion(*grid_, names)));
    }

    // Of the sensors that have a value, all bands weighted as the eye does.
    void tell_grid(const Solution& solution, const std::vector<double>& values,
                   std::size_t columns) const {
        double least = std::numeric_limits<double>::infinity(), largest = 0, sum = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < values.size(); i += columns) {
            const auto first = values.begin() + std::ptrdiff_t(i);
            const double E =
                luminance(Spectrum(first, first + std::ptrdiff_t(solution.bands.size())));
            if (std::isnan(E)) continue;
            least = std::min(least, E), largest = std::max(largest, E), sum += E;
            ++count;
        }
        if (count == 0) return;
        const double mean = sum / double(count);
        const std::string unit = irradiance_unit(solution.quantity);
        fmt::print(stderr, "grid {}: {}, min {}, mean {}, max {}{}\n", *grid_,
                   plural(count, "point", "points"), human_quantity(least, unit),
                   human_quantity(mean, unit), human_quantity(largest, unit),
                   mean > 0 ? fmt::format(", uniformity {:.2f} (min / mean)", least / mean) : "");
    }

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
