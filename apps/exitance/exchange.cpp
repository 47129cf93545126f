// SPDX-License-Identifier: Apache-2.0
// exitance exchange: who radiates how much heat to whom in an enclosure.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "commands.h"
#include "csv_cells.h"
#include "exitance/formfactor/form_factors.h"
#include "exitance/run/atomic_file.h"
#include "exitance/scene/read.h"
#include "exitance/solve/net_radiation.h"
#include "human_number.h"
#include "interrupt.h"
#include "options_cli.h"
#include "output_path.h"
#include "progress_bar.h"
#include "summary.h"
#include "thermal_surfaces.h"

namespace exitance::cli {

namespace {

// Row sums of a closed enclosure miss 1 by the errors of the factors, not by more.
constexpr double closed_within = 0.01;

std::string celsius(double kelvin) {
    return std::isnan(kelvin) ? "–" : fmt::format("{:.2f}", kelvin - 273.15);
}

std::string kelvin_text(double kelvin) {
    return std::isnan(kelvin) ? "–" : fmt::format("{:.2f}", kelvin);
}

std::string table(const NetRadiation& result, const std::vector<ThermalSurface>& surfaces,
                  const FormFactors& made) {
    std::size_t width = 4;
    for (const ExchangeSurface& surface : made.enclosure.surfaces)
        width = std::min<std::size_t>(40, std::max(width, surface.name.size()));
    std::string out =
        fmt::format("{:<{}} {:>9} {:>5} {:>9} {:>9} {:>10} {:>10} {:>10} {:>10}\n", "name", width,
                    "A [m²]", "ε", "T [K]", "T [°C]", "J [W/m²]", "H [W/m²]", "q [W/m²]", "Q [W]");
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const RadiatingSurface& s = result.surfaces[i];
        out +=
            fmt::format("{:<{}} {:>9} {:>5.3g} {:>9} {:>9} {:>10} {:>10} {:>10} {:>10}\n",
                        made.enclosure.surfaces[i].name, width, human_number(made.F.areas()[i]),
                        surfaces[i].emissivity, kelvin_text(s.temperature), celsius(s.temperature),
                        human_number(s.radiosity), human_number(s.irradiation),
                        human_number(s.heat_flux), human_number(s.heat));
    }
    return out;
}

std::string balance_line(const NetRadiation& result) {
    double given = 0, taken = 0;
    for (const RadiatingSurface& s : result.surfaces) (s.heat > 0 ? given : taken) += s.heat;
    return fmt::format(
        "balance: {} W given = {} W taken in + {} W lost to the surroundings; off by {:.1g} W\n",
        human_number(given), human_number(-taken), human_number(result.lost),
        std::abs(result.imbalance));
}

void write_csv(std::ostream& out, const NetRadiation& result,
               const std::vector<ThermalSurface>& surfaces, const FormFactors& made) {
    out << "name,area,emissivity,temperature,radiosity,irradiation,heat_flux,heat\n";
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const RadiatingSurface& s = result.surfaces[i];
        out << csv_cell(made.enclosure.surfaces[i].name)
            << fmt::format(",{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g}\n", made.F.areas()[i],
                           surfaces[i].emissivity,
                           std::isnan(s.temperature) ? "" : fmt::format("{:.9g}", s.temperature),
                           s.radiosity, s.irradiation, s.heat_flux, s.heat);
    }
}

FormFactorOptions by_surface() {
    FormFactorOptions options;
    options.enclosure.by = "surface";
    return options;
}

class ExchangeCommand {
  public:
    explicit ExchangeCommand(CLI::App& command)
        : given_(command, "Form factors", describe(options_)),
          reading_(command, "Reading a scene", describe(read_options_)) {
        command
            .add_option("scene", scene_,
                        "the enclosure: .vs3 with its emissivities, or any scene that solve reads "
                        "(emissivity = 1 − mean reflectance)")
            ->required();
        command
            .add_option("--surfaces", table_,
                        "a table with the columns name and any of temperature, heat_flux [W/m²], "
                        "power [W], emissivity; a name may be a pattern (wall*)")
            ->type_name("file.csv");
        using What = ThermalRule::What;
        add_rule(command, "--temperature", What::temperature, "NAME=T",
                 "temperature of the surfaces of that name: 350, \"350 K\" or \"77 C\"");
        add_rule(command, "--heat-flux", What::heat_flux, "NAME=W/m²",
                 "net heat they send out per area; 0 for surfaces that only reradiate");
        add_rule(command, "--power", What::power, "NAME=W",
                 "net heat that all of that name send out together");
        add_rule(command, "--emissivity", What::emissivity, "NAME=0…1", "instead of the scene's");
        command
            .add_option("--surroundings", surroundings_,
                        "temperature of what is seen through the openings of an enclosure")
            ->type_name("T");
        command.add_option("--output,-o", output_, "the same table with all digits, in K and W")
            ->type_name("file.csv");
        reporting_.add_to(command);
        command.footer(
            "Later wins: the table first, then the options in their order. A surface's net heat "
            "is\n"
            "positive where it heats the others. Radiosity is even over each surface: --by patch\n"
            "resolves it.\n"
            "\n"
            "Example:\n"
            "  exitance exchange scenes/two_boxes.vs3 --temperature 'room_*=20 C' \\\n"
            "    --temperature 'room_floor=35 C' --power 'box_*=100' -o heat.csv");
    }

    void run() {
        if (!output_.empty()) {
            require_output(output_, scene_, {".csv"});
            if (!table_.empty()) require_output(output_, table_, {".csv"});
        }
        reading_.apply({});
        std::optional<double> surroundings;
        if (!surroundings_.empty()) surroundings = surroundings_temperature();
        std::vector<ThermalRule> rules;
        if (!table_.empty()) rules = read_rules(table_);
        rules.insert(rules.end(), rules_.begin(), rules_.end());

        const Scene scene = read_scene(scene_, read_options_);
        if (!reporting_.quiet) print_findings(scene);
        given_.apply({});
        const std::vector<ThermalSurface> surfaces =
            apply_rules(rules, make_enclosure(scene, options_.enclosure).surfaces);
        const Interrupt interrupt;
        FormFactors made =
            form_factors(scene, options_, make_observer(reporting_), &interrupt.cancel());
        clear_bar(reporting_);
        close(made);
        const double opening = largest_opening(made.F);
        if (opening > 0 && !surroundings)
            throw Error(Fault::bad_input,
                        fmt::format("the enclosure is open, {} of what leaves '{}' gets out; "
                                    "expected --surroundings",
                                    human_percent(1 - made.enforced.least_sum),
                                    made.names()[made.enforced.least_row]));
        const NetRadiation result =
            net_radiation(made.F, surfaces, surroundings.value_or(0), made.names());
        if (!output_.empty())
            write_atomically(output_,
                             [&](std::ostream& out) { write_csv(out, result, surfaces, made); });
        if (reporting_.quiet) return;
        std::fputs(table(result, surfaces, made).c_str(), stdout);
        std::fputs(balance_line(result).c_str(), stdout);
    }

  private:
    void add_rule(CLI::App& command, const std::string& name, ThermalRule::What what,
                  const char* type, const char* says) {
        command
            .add_option_function<std::vector<std::string>>(
                name,
                [this, name, what](const std::vector<std::string>& texts) {
                    for (const std::string& text : texts)
                        rules_.push_back(parse_rule(text, what, name));
                },
                says)
            ->type_name(type)
            ->trigger_on_parse();
    }

    double surroundings_temperature() const {
        try {
            return parse_temperature(surroundings_, Place{});
        } catch (const Error& error) {
            throw Error(Fault::wrong_use, std::string("--surroundings: ") + error.what());
        }
    }

    // Heat balances only where A F is symmetric, and where rows add up in a closed enclosure.
    void close(FormFactors& made) const {
        if (options_.enforce != "none") return;
        const bool closed = made.computed.least_sum > 1 - closed_within &&
                            made.computed.most_sum < 1 + closed_within;
        made.F = enforced(std::move(made.F), closed ? Enforce::both : Enforce::reciprocity,
                          made.names());
        made.enforced = quality(made.F);
    }

    FormFactorOptions options_ = by_surface();
    GivenOptions given_;
    ReadOptions read_options_;
    GivenOptions reading_;
    std::filesystem::path scene_, table_, output_;
    std::string surroundings_;
    std::vector<ThermalRule> rules_;
    Reporting reporting_;
};

}  // namespace

void add_exchange(CLI::App& app) {
    CLI::App& command = *app.add_subcommand(
        "exchange", "net radiation between the surfaces of a scene: temperatures and heat");
    const auto exchange = std::make_shared<ExchangeCommand>(command);
    command.callback([exchange] { exchange->run(); });
}

}  // namespace exitance::cli
