// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/toml_table.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

Place place_of(const std::string& file, const toml::node& node) {
    return {file, node.source().begin.line, node.source().begin.column};
}

// What a value is called in messages.
std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::string:
            return "the string";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "the number";
        case toml::node_type::boolean:
            return "the flag";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::table:
            return "a table";
        default:
            return "the date or time";
    }
}

// Ends that nobody meets are named to those who have gone beyond.
std::string range_text(double least, double most, const std::optional<double>& found) {
    const bool too_much = found && *found > most, too_little = found && *found < least;
    if (!too_much && most >= limits::coordinate) {
        if (!too_little && least <= -limits::coordinate) return "a number";
        return fmt::format("a number from {:g} up", least);
    }
    return fmt::format("a number from {:g} to {:g}", least, most);
}

// A value as it can be shown in a message; arrays and tables by their kind.
std::string shown(const toml::node& node) {
    if (node.is_table() || node.is_array()) return kind_of(node);
    std::ostringstream out;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_value<decltype(value)>) out << value.get();
    });
    return fmt::format("{} {}", kind_of(node), in_quotes(out.str()));
}

std::optional<double> finite(const toml::node& node) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

TomlTable::TomlTable(std::string file, std::shared_ptr<const toml::table> table, std::string name,
                     const std::vector<std::string>& keys)
    : file_(std::move(file)), name_(std::move(name)), table_(std::move(table)) {
    for (const auto& [key, value] : *table_) {
        const std::string word(key.str());
        if (std::find(keys.begin(), keys.end(), word) != keys.end()) continue;
        const auto& at = key.source().begin;
        throw Error({file_, at.line, at.column},
                    fmt::format("found {} in {}, which has no such key{}", in_quotes(word), name_,
                                suggestion(word, keys)));
    }
}

namespace {

// The parser descends into dotted keys one call a part.
void refuse_endless_keys(const std::string& file, std::string_view text) {
    constexpr std::size_t most_parts = 256;
    std::size_t line = 1, dots = 0;
    bool key = true;
    for (const char c : text) {
        if (c == '\n') {
            ++line, dots = 0, key = true;
        } else if (c == '=' || c == '#') {
            key = false;
        } else if (key && c == '.' && ++dots > most_parts) {
            throw Error({file, line, 1}, "found a key of more than 256 parts");
        }
    }
}

}  // namespace

TomlTable TomlTable::parse(const std::string& file, std::string_view text, const std::string& name,
                           const std::vector<std::string>& keys) {
    refuse_endless_keys(file, text);
    try {
        return {file, std::make_shared<const toml::table>(toml::parse(text, file)), name, keys};
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw Error({file, std::max<std::size_t>(at.line, 1), std::max<std::size_t>(at.column, 1)},
                    "not TOML: " + as_utf8(error.description()));
    }
}

const toml::node* TomlTable::node(const std::string& key) const {
    return table_->get(key);
}

Place TomlTable::place() const {
    return place_of(file_, *table_);
}

bool TomlTable::is_number(const std::string& key) const {
    return has(key) && node(key)->is_number();
}

bool TomlTable::is_array(const std::string& key) const {
    return has(key) && node(key)->is_array();
}

Place TomlTable::place(const std::string& key) const {
    const toml::node* found = node(key);
    return found ? place_of(file_, *found) : place();
}

void TomlTable::refuse(const std::string& key, const std::string& what) const {
    const toml::node* found = node(key);
    if (!found) throw Error(place(), fmt::format("{} has no '{}', expected {}", name_, key, what));
    throw Error(place_of(file_, *found),
                fmt::format("{}: found {}, expected {}", key, shown(*found), what));
}

void TomlTable::require(const std::string& key) const {
    if (!has(key)) throw Error(place(), fmt::format("{} has no '{}'", name_, key));
}

std::optional<std::string> TomlTable::text(const std::string& key) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    if (!found->is_string()) refuse(key, "a string");
    return as_utf8(found->as_string()->get());
}

std::optional<bool> TomlTable::flag(const std::string& key) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    if (!found->is_boolean()) refuse(key, "true or false");
    return found->as_boolean()->get();
}

std::optional<double> TomlTable::number(const std::string& key, double least, double most) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    const auto value = finite(*found);
    if (!value || *value < least || *value > most) refuse(key, range_text(least, most, value));
    return value;
}

std::optional<std::uint32_t> TomlTable::count(const std::string& key, std::uint32_t least,
                                              std::uint32_t most) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    const auto* value = found->as_integer();
    if (!value || value->get() < least || value->get() > most)
        refuse(key, fmt::format("a whole number from {} to {}", least, most));
    return static_cast<std::uint32_t>(value->get());
}

std::vector<double> TomlTable::numbers_of(const toml::node& node, std::size_t size, double least,
                                          double most, const std::string& key) const {
    const toml::array* array = node.as_array();
    const std::string what = fmt::format("{} numbers in brackets", size);
    if (!array)
        throw Error(place_of(file_, node),
                    fmt::format("{}: found {}, expected {}", key, shown(node), what));
    if (array->size() != size)
        throw Error(place_of(file_, node),
                    fmt::format("{}: found an array of {}, expected {}", key, array->size(), what));
    std::vector<double> out;
    for (const toml::node& element : *array) {
        const auto value = finite(element);
        if (!value || *value < least || *value > most)
            throw Error(place_of(file_, element),
                        fmt::format("{}: found {}, expected {}", key, shown(element),
                                    range_text(least, most, value)));
        out.push_back(*value);
    }
    return out;
}

std::optional<std::vector<double>> TomlTable::numbers(const std::string& key, std::size_t size,
                                                      double least, double most) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    return numbers_of(*found, size, least, most, key);
}

std::optional<Vec3> TomlTable::vector(const std::string& key) const {
    const auto v = numbers(key, 3, -limits::coordinate, limits::coordinate);
    if (!v) return std::nullopt;
    return Vec3{(*v)[0], (*v)[1], (*v)[2]};
}

std::optional<Spectrum> TomlTable::spectrum(const std::string& key, double least,
                                            double most) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    if (found->is_array()) return numbers_of(*found, 3, least, most, key);
    const auto value = finite(*found);
    if (!value || *value < least || *value > most)
        refuse(key, range_text(least, most, value) + ", or three of them in brackets");
    return Spectrum(3, *value);
}

std::optional<std::vector<Vec3>> TomlTable::points(const std::string& key) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    const toml::array* array = found->as_array();
    if (!array) refuse(key, "a list of points [[x, y, z], …]");
    std::vector<Vec3> out;
    for (const toml::node& element : *array) {
        const auto v = numbers_of(element, 3, -limits::coordinate, limits::coordinate, key);
        out.push_back({v[0], v[1], v[2]});
    }
    return out;
}

std::optional<TomlTable::Time> TomlTable::time(const std::string& key) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    const auto* value = found->as_date_time();
    if (!value) refuse(key, "a date and time, like 2026-06-21T12:00:00");
    const toml::date_time& t = value->get();
    Time out;
    out.moment.year = t.date.year, out.moment.month = t.date.month, out.moment.day = t.date.day;
    out.moment.hour = t.time.hour, out.moment.minute = t.time.minute;
    out.moment.second = t.time.second + 1e-9 * t.time.nanosecond;
    out.has_zone = t.offset.has_value();
    if (t.offset) out.moment.zone = t.offset->minutes / 60.0;
    return out;
}

std::optional<TomlTable> TomlTable::table(const std::string& key,
                                          const std::vector<std::string>& keys) const {
    const toml::node* found = node(key);
    if (!found) return std::nullopt;
    if (!found->is_table()) refuse(key, "a table that begins with [" + key + "]");
    return TomlTable(file_, {table_, found->as_table()}, "[" + key + "]", keys);
}

std::vector<TomlTable> TomlTable::tables(const std::string& key,
                                         const std::vector<std::string>& keys) const {
    const toml::node* found = node(key);
    std::vector<TomlTable> out;
    if (!found) return out;
    const toml::array* array = found->as_array();
    const std::string heading = "[[" + key + "]]";
    if (!array) refuse(key, "tables that begin with " + heading);
    for (const toml::node& element : *array) {
        if (!element.is_table())
            throw Error(place_of(file_, element),
                        fmt::format("{}: found {}, expected tables that begin with {}", key,
                                    shown(element), heading));
        out.push_back({file_, {table_, element.as_table()}, heading, keys});
    }
    return out;
}

std::vector<TomlTable::Scalar> TomlTable::scalars(const std::string& key) const {
    const toml::node* found = node(key);
    std::vector<Scalar> out;
    if (!found) return out;
    if (!found->is_table()) refuse(key, "a table that begins with [" + key + "]");
    return scalars_of(*found->as_table());
}

std::vector<std::pair<Place, std::vector<TomlTable::Scalar>>> TomlTable::scalar_tables(
    const std::string& key) const {
    const toml::node* found = node(key);
    std::vector<std::pair<Place, std::vector<Scalar>>> out;
    if (!found) return out;
    const toml::array* array = found->as_array();
    if (!array) refuse(key, "tables that begin with [[" + key + "]]");
    for (const toml::node& element : *array) {
        if (!element.is_table())
            throw Error(place_of(file_, element),
                        fmt::format("{}: found {}, expected tables that begin with [[{}]]", key,
                                    shown(element), key));
        out.push_back({place_of(file_, element), scalars_of(*element.as_table())});
    }
    return out;
}

std::vector<TomlTable::Scalar> TomlTable::scalars_of(const toml::table& table) const {
    std::vector<Scalar> out;
    for (const auto& [name, value] : table) {
        Scalar scalar;
        scalar.name = std::string(name.str());
        scalar.place = place_of(file_, value);
        if (value.is_string())
            scalar.value = value.as_string()->get();
        else if (value.is_boolean())
            scalar.value = value.as_boolean()->get() ? "true" : "false";
        else if (value.is_integer())
            scalar.value = std::to_string(value.as_integer()->get());
        else if (value.is_floating_point())
            scalar.value = fmt::format("{}", value.as_floating_point()->get());
        else
            throw Error(scalar.place,
                        fmt::format("{}: found {}, expected a word, a number, true or false",
                                    scalar.name, kind_of(value)));
        out.push_back(std::move(scalar));
    }
    return out;
}

}  // namespace exitance
