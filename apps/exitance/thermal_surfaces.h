// SPDX-License-Identifier: Apache-2.0
// What is said of surfaces by their names: temperatures, heat, emissivities, from a table and from
// the command line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exitance/formfactor/enclosure.h"
#include "exitance/run/error.h"
#include "exitance/solve/net_radiation.h"

namespace exitance::cli {

/// A temperature as it is typed: "300", "300 K", "26.85 C", "26.85 °C" [K]. Throws Error with
/// `place`.
double parse_temperature(const std::string& text, const Place& place);

/// One thing said about all surfaces whose names match.
struct ThermalRule {
    enum class What { temperature, heat_flux, power, emissivity };
    std::string pattern;  ///< "wall*"
    What what;
    double value;  ///< [K], [W/m²], [W] for all that match together, or 0 … 1
    Place place;   ///< for errors
};

/// "floor=350 K" of an option called `option`.
ThermalRule parse_rule(const std::string& text, ThermalRule::What what, const std::string& option);

/// A table with a column `name` and any of temperature, heat_flux, power and emissivity; empty
/// cells say nothing. Throws Error(bad_input) with file:line:column.
std::vector<ThermalRule> read_rules(const std::filesystem::path& file);

/// Later rules win; a temperature and a heat replace each other. Emissivities are the enclosure's
/// where no rule sets them. Throws Error if a pattern matches nothing.
std::vector<ThermalSurface> apply_rules(const std::vector<ThermalRule>& rules,
                                        const std::vector<ExchangeSurface>& surfaces);

}  // namespace exitance::cli
