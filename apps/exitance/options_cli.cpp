// SPDX-License-Identifier: Apache-2.0
#include "options_cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "exitance/run/error.h"

namespace exitance::cli {

namespace {

/// What stands for the value in --help: the choices, the unit or the kind.
std::string value_name(const Option& option) {
    if (!option.choices.empty()) return fmt::format("{}", fmt::join(option.choices, "|"));
    if (!option.unit.empty()) return option.unit;
    const bool text = std::holds_alternative<std::string*>(option.target) ||
                      std::holds_alternative<std::optional<std::string>*>(option.target);
    return text ? "text" : "number";
}

/// What it does, and the range where it is bounded.
std::string description(const Option& option) {
    const bool bounded = std::isfinite(option.least) || std::isfinite(option.most);
    if (!option.choices.empty() || option.is_flag() || !bounded) return option.what;
    return fmt::format("{} ({})", option.what, option.range_text());
}

}  // namespace

GivenOptions::GivenOptions(CLI::App& command, const std::string& group, Options options)
    : options_(std::move(options)) {
    for (const Option& option : options_) {
        if (option.is_flag()) {
            const auto store = [this, name = option.name](std::int64_t count) {
                given_[name] = count > 0 ? "true" : "false";
            };
            command
                .add_flag_function(fmt::format("--{0},!--no-{0}", option.name), store, option.what)
                ->default_str(option.value_text() == "true" ? "on" : "off")
                ->group(group);
        } else {
            const auto store = [this, &option](const std::string& text) {
                option.set(text);  // refused before any work begins
                given_[option.name] = text;
            };
            command
                .add_option_function<std::string>("--" + option.name, store, description(option))
                ->type_name(value_name(option))
                ->default_str(option.value_text())
                ->group(group);
        }
    }
}

void apply_settings(const std::vector<Setting>& settings, const Options& options) {
    for (const Setting& setting : settings) {
        try {
            find_option(options, setting.name).set(setting.value);
        } catch (const Error& error) {
            throw Error(setting.place, error.what());
        }
    }
}

void GivenOptions::apply(const std::vector<Setting>& settings) const {
    apply_settings(settings, options_);
    for (const auto& [name, text] : given_) find_option(options_, name).set(text);
}

}  // namespace exitance::cli
