// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "exitance/run/error.h"

namespace exitance {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

[[noreturn]] void refuse(const Option& option, const std::string& text) {
    const std::string range = option.range_text();
    throw Error(Fault::wrong_use, fmt::format("--{}: '{}' is not allowed, expected {}", option.name,
                                              text, range.empty() ? "a value" : range));
}

bool inside(const Option& option, double value) {
    return std::isfinite(value) && value >= option.least && value <= option.most;
}

// What a number with `suffix` behind it is multiplied by: the option's unit may be written out,
// times may be in minutes and hours, pure numbers in percent. 0 for anything else.
double suffix_factor(const Option& option, std::string_view suffix) {
    if (suffix.empty() || suffix == option.unit) return 1;
    if (option.unit == "s" && suffix == "min") return 60;
    if (option.unit == "s" && suffix == "h") return 3600;
    if (option.unit.empty() && suffix == "%") return 0.01;
    return 0;
}

double parse_number(const Option& option, const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{}) refuse(option, text);
    const double factor = suffix_factor(option, {rest, end});
    value *= factor;
    if (factor == 0 || !inside(option, value)) refuse(option, text);
    return value;
}

template <class Integer>
Integer parse_integer(const Option& option, const std::string& text) {
    Integer value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || rest != end || !inside(option, static_cast<double>(value)))
        refuse(option, text);
    return value;
}

const std::string& one_of_choices(const Option& option, const std::string& text) {
    for (const std::string& choice : option.choices)
        if (choice == text) return text;
    if (!option.choices.empty()) refuse(option, text);
    return text;
}

}  // namespace

std::string Option::value_text() const {
    return std::visit(
        Overloaded{[](const bool* v) { return std::string(*v ? "true" : "false"); },
                   [](const int* v) { return std::to_string(*v); },
                   [](const std::uint64_t* v) { return std::to_string(*v); },
                   [](const double* v) { return fmt::format("{}", *v); },
                   [](const std::optional<double>* v) { return *v ? fmt::format("{}", **v) : ""; },
                   [](const std::string* v) { return *v; },
                   [](const std::optional<std::string>* v) { return v->value_or(""); }},
        target);
}

std::string Option::range_text() const {
    if (!choices.empty()) return fmt::format("one of {}", fmt::join(choices, ", "));
    if (is_flag()) return "true or false";
    const bool low = std::isfinite(least), high = std::isfinite(most);
    if (low && high) return fmt::format("{:g} … {:g}", least, most);
    if (low) return fmt::format("at least {:g}", least);
    if (high) return fmt::format("at most {:g}", most);
    const bool text = std::holds_alternative<std::string*>(target) ||
                      std::holds_alternative<std::optional<std::string>*>(target);
    return text ? "" : "a number";
}

void Option::check(double value) const {
    if (!inside(*this, value)) refuse(*this, fmt::format("{}", value));
}

void Option::set(const std::string& text) const {
    const auto integer = [&]<class Integer>(Integer* v) {
        *v = parse_integer<Integer>(*this, text);
    };
    std::visit(Overloaded{[&](bool* v) {
                              if (text != "true" && text != "false") refuse(*this, text);
                              *v = text == "true";
                          },
                          [&](int* v) { integer(v); }, [&](std::uint64_t* v) { integer(v); },
                          [&](double* v) { *v = parse_number(*this, text); },
                          [&](std::optional<double>* v) { *v = parse_number(*this, text); },
                          [&](std::string* v) { *v = one_of_choices(*this, text); },
                          [&](std::optional<std::string>* v) { *v = one_of_choices(*this, text); }},
               target);
}

const Option& find_option(const Options& options, const std::string& name) {
    std::vector<std::string> names;
    for (const Option& option : options) {
        if (option.name == name) return option;
        names.push_back(option.name);
    }
    throw Error(Fault::wrong_use,
                fmt::format("unknown option '{}'{}", name, suggestion(name, names)));
}

}  // namespace exitance
