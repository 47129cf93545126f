// SPDX-License-Identifier: Apache-2.0
#include "thermal_surfaces.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

#include "csv_cells.h"
#include "exitance/scene/formats/glob.h"

namespace exitance::cli {

namespace {

using What = ThermalRule::What;

constexpr double zero_celsius = 273.15, hottest = 1e6, most_heat = 1e15;

const std::map<std::string, What, std::less<>> columns{{"temperature", What::temperature},
                                                       {"heat_flux", What::heat_flux},
                                                       {"power", What::power},
                                                       {"emissivity", What::emissivity}};

// Words of the command line have no place.
[[noreturn]] void refuse(const Place& place, const std::string& what) {
    if (place.file.empty()) throw Error(Fault::wrong_use, what);
    throw Error(place, what);
}

// The number at the start of `text` and what follows it.
std::pair<double, std::string_view> leading_number(std::string_view text, const Place& place,
                                                   const char* expected) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || !std::isfinite(value))
        refuse(place, fmt::format("found '{}', expected {}", text, expected));
    return {value, trimmed({rest, static_cast<std::size_t>(end - rest)})};
}

double parse_value(std::string_view text, What what, const Place& place) {
    if (what == What::temperature) return parse_temperature(std::string(text), place);
    const char* expected = what == What::emissivity ? "an emissivity, 0 to 1"
                           : what == What::power    ? "heat in W"
                                                    : "a heat flux in W/m²";
    const auto [value, unit] = leading_number(text, place, expected);
    const bool known = unit.empty() || (what == What::power && unit == "W") ||
                       (what == What::heat_flux && (unit == "W/m²" || unit == "W/m2"));
    const bool inside =
        what == What::emissivity ? value >= 0 && value <= 1 : std::abs(value) <= most_heat;
    if (!known || !inside) refuse(place, fmt::format("found '{}', expected {}", text, expected));
    return value;
}

}  // namespace

double parse_temperature(const std::string& text, const Place& place) {
    constexpr const char* expected = "a temperature, \"300 K\" or \"27 C\"";
    const auto [value, unit] = leading_number(trimmed(text), place, expected);
    const bool celsius = unit == "C" || unit == "°C";
    const double kelvin = celsius ? value + zero_celsius : value;
    if (!(celsius || unit.empty() || unit == "K") || kelvin < 0 || kelvin > hottest)
        refuse(place, fmt::format("found '{}', expected {}", text, expected));
    return kelvin;
}

ThermalRule parse_rule(const std::string& text, What what, const std::string& option) {
    // The last sign: names may hold one.
    const std::size_t sign = text.rfind('=');
    try {
        if (sign == std::string::npos || sign == 0)
            refuse(Place{}, fmt::format("found '{}', expected NAME=VALUE", text));
        return {text.substr(0, sign), what,
                parse_value(trimmed(std::string_view(text).substr(sign + 1)), what, Place{}),
                Place{}};
    } catch (const Error& error) {
        throw Error(Fault::wrong_use, option + ": " + error.what());
    }
}

std::vector<ThermalRule> read_rules(const std::filesystem::path& file) {
    std::error_code unknown;
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file, unknown))
        throw Error(Place{file.string()}, "cannot be read, expected a table of surfaces");
    std::string line;
    constexpr const char* wanted =
        "expected a header with name and any of temperature, heat_flux, power, emissivity";
    if (!next_line(in, line))
        throw Error(Place{file.string(), 1, 1}, "found nothing, " + std::string(wanted));
    if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    const std::string header_line = line;
    std::vector<std::string> header;
    bool named = false;
    for (const Cell& cell : cells_of(header_line)) {
        header.emplace_back(unquoted(cell.text));
        named |= header.back() == "name";
        if (header.back() != "name" && !columns.contains(header.back()))
            throw Error(Place{file.string(), 1, cell.column},
                        fmt::format("found a column '{}', {}", header.back(), wanted));
    }
    if (!named)
        throw Error(Place{file.string(), 1, 1}, fmt::format("found no column 'name', {}", wanted));

    std::vector<ThermalRule> rules;
    for (std::size_t number = 2; next_line(in, line); ++number) {
        if (trimmed(line).empty()) continue;
        const std::vector<Cell> cells = cells_of(line);
        if (cells.size() != header.size())
            throw Error(Place{file.string(), number, cells.back().column},
                        fmt::format("found {} columns, expected {} as in the header", cells.size(),
                                    header.size()));
        std::string name;
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (header[k] == "name") name = unquoted(cells[k].text);
        for (std::size_t k = 0; k < cells.size(); ++k) {
            if (header[k] == "name" || cells[k].text.empty()) continue;
            const Place place{file.string(), number, cells[k].column};
            const What what = columns.find(header[k])->second;
            rules.push_back({name, what, parse_value(unquoted(cells[k].text), what, place), place});
        }
    }
    if (in.bad()) throw Error(Place{file.string()}, "cannot be read to its end");
    return rules;
}

std::vector<ThermalSurface> apply_rules(const std::vector<ThermalRule>& rules,
                                        const std::vector<ExchangeSurface>& surfaces) {
    std::vector<ThermalSurface> out;
    std::vector<std::string> names;
    for (const ExchangeSurface& surface : surfaces) {
        out.push_back({surface.emissivity, {}, {}});
        names.push_back(surface.name);
    }
    for (const ThermalRule& rule : rules) {
        std::vector<std::size_t> matching;
        double area = 0;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (!matches_glob(rule.pattern, names[i])) continue;
            matching.push_back(i);
            area += surfaces[i].area;
        }
        if (matching.empty()) {
            const std::string what = fmt::format("no surface is called '{}'{}", rule.pattern,
                                                 suggestion(rule.pattern, names));
            refuse(rule.place, what);
        }
        for (const std::size_t i : matching) {
            ThermalSurface& surface = out[i];
            if (rule.what == What::emissivity) {
                surface.emissivity = rule.value;
            } else if (rule.what == What::temperature) {
                surface.temperature = rule.value;
                surface.heat_flux.reset();
            } else {
                surface.heat_flux = rule.what == What::power ? rule.value / area : rule.value;
                surface.temperature.reset();
            }
        }
    }
    return out;
}

}  // namespace exitance::cli
