// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/luminaire_keys.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "exitance/scene/colour_temperature.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/toml_direction.h"

namespace exitance {

namespace {

constexpr std::uint32_t most_in_a_row = 10'000;

std::uint32_t in_a_row(const TomlTable& table, const char* key) {
    return table.count(key, 1, most_in_a_row).value_or(1);
}

}  // namespace

Spectrum lamp_colour(const TomlTable& table) {
    if (table.has("color_temperature")) {
        if (table.has("color"))
            throw Error(table.place("color_temperature"),
                        "found both 'color' and 'color_temperature', expected one of them");
        return colour_of_temperature(
            *table.number("color_temperature", warmest_light, coolest_light));
    }
    Spectrum colour = table.spectrum("color", 0, limits::exitance).value_or(Spectrum(3, 1.0));
    const double value = luminance(colour);
    if (!(value > limits::length)) table.refuse("color", "a colour that is not black");
    for (double& band : colour) band /= value;
    return colour;
}

double lamp_factor(const TomlTable& table) {
    return table.number("multiplier", 0, 1e9).value_or(1) *
           table.number("dimming", 0, 1).value_or(1) *
           table.number("maintenance", 0, 1).value_or(1);
}

Vec3 lamp_aim(const TomlTable& table, const Vec3& position, const std::optional<Vec3>& otherwise) {
    if (const auto target = table.vector("target")) {
        if (table.has("aim"))
            throw Error(table.place("target"),
                        "found both 'aim' and 'target', expected one of them");
        if (!(length(*target - position) > limits::length))
            table.refuse("target", "a point that is not the lamp's own");
        return normalized(*target - position);
    }
    if (!otherwise) table.require("aim");
    return direction(table, "aim", otherwise.value_or(Vec3{}));
}

std::uint64_t lamp_count(const TomlTable& table) {
    return std::uint64_t{in_a_row(table, "columns")} * in_a_row(table, "rows");
}

std::vector<Vec3> lamp_positions(const TomlTable& table) {
    const Vec3 middle = *table.vector("position");
    const std::uint32_t columns = in_a_row(table, "columns"), rows = in_a_row(table, "rows");
    if (columns * rows == 1) {
        if (table.has("spacing"))
            throw Error(table.place("spacing"),
                        "found 'spacing' of a single lamp, expected 'columns' or 'rows' with it");
        return {middle};
    }
    table.require("spacing");
    const std::vector<double> spacing =
        *table.numbers("spacing", 2, -limits::coordinate, limits::coordinate);
    // Counter-clockwise seen from above: x turns to −z.
    const double turn =
        table.number("array_rotation", -360, 360).value_or(0) * std::numbers::pi / 180;
    const Vec3 along{std::cos(turn) * spacing[0], 0, -std::sin(turn) * spacing[0]};
    const Vec3 across{std::sin(turn) * spacing[1], 0, std::cos(turn) * spacing[1]};
    std::vector<Vec3> out;
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c)
            out.push_back(middle + along * (c - 0.5 * (columns - 1)) +
                          across * (r - 0.5 * (rows - 1)));
    return out;
}

void refuse_keys(const TomlTable& table, const std::string& kind,
                 const std::vector<std::string>& unused) {
    for (const std::string& key : unused)
        if (table.has(key))
            throw Error(table.place(key), fmt::format("a {} has no '{}'", kind, key));
}

}  // namespace exitance
