// SPDX-License-Identifier: Apache-2.0
#include "help_text.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <vector>

namespace exitance::cli {

namespace {

constexpr std::size_t page_width = 100;
constexpr std::size_t name_width = 30;

/// Characters, not bytes: UTF-8 continuation bytes do not count.
std::size_t width(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) count += (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
    return count;
}

/// "-o, --output <file>", or the name alone for a positional.
std::string option_name(const CLI::Option& option) {
    std::string out;
    if (!option.nonpositional()) {
        out = option.get_name(true, false);
    } else {
        for (const std::string& name : option.get_snames()) out += ", -" + name;
        for (const std::string& name : option.get_lnames()) out += ", --" + name;
        out.erase(0, 2);
    }
    if (option.nonpositional() && option.get_expected_max() > 0)
        out += fmt::format(" <{}>", option.get_type_name());
    return out;
}

std::string option_text(const CLI::Option& option) {
    std::string out = option.get_description();
    if (!option.get_default_str().empty())
        out += fmt::format(" [{}]", option.get_default_str());
    else if (option.get_required() && option.nonpositional())
        out += " [required]";
    return out;
}

/// "exitance solve scene -o, --output <file.glb> [options]"
std::string usage(const CLI::App& command) {
    if (command.get_parent() == nullptr) return command.get_name() + " COMMAND [options]";
    std::string out = fmt::format("{} {}", command.get_parent()->get_name(), command.get_name());
    for (const CLI::Option* option : command.get_options()) {
        if (option->nonpositional() && !option->get_required()) continue;
        const bool may_lack = !option->nonpositional() && !option->get_required();
        out += may_lack ? fmt::format(" [{}]", option_name(*option)) : " " + option_name(*option);
    }
    return out + " [options]";
}

/// `name` on the left, `text` in a column of its own on the right.
std::string two_columns(const std::string& name, const std::string& text) {
    std::string out = "  " + name;
    std::size_t column = 2 + width(name);
    const auto go_to_text = [&] {
        out.append(name_width - column, ' ');
        column = name_width;
    };
    if (column + 2 > name_width) {
        out += "\n";
        column = 0;
    }
    go_to_text();
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column > name_width && column + 1 + width(word) > page_width) {
            out += "\n";
            column = 0;
            go_to_text();
        } else if (column > name_width) {
            out += " ";
            ++column;
        }
        out += word;
        column += width(word);
    }
    return out + "\n";
}

class HelpLayout : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool) const override {
        return two_columns(option_name(*option), option_text(*option));
    }
    std::string make_subcommand(const CLI::App* command) const override {
        return two_columns(command->get_name(), command->get_description());
    }
    std::string make_description(const CLI::App* command) const override {
        return command->get_description() + "\n\n";
    }
    std::string make_usage(const CLI::App* command, std::string) const override {
        return "Usage: " + usage(*command) + "\n";
    }
    std::string make_group(std::string group, bool positional,
                           std::vector<const CLI::Option*> options) const override {
        std::string out = "\n" + group + ":\n";
        for (const CLI::Option* option : options) out += make_option(option, positional);
        return out;
    }
};

std::string table_cell(const std::string& text) {
    return CLI::detail::find_and_replace(text, "|", "\\|");
}

}  // namespace

void use_help_layout(CLI::App& app) {
    app.formatter(std::make_shared<HelpLayout>());
}

std::string manual(const CLI::App& app) {
    std::string out = fmt::format("# The commands of {}\n\n{}\n", app.get_name(),
                                  "Written by `exitance manual` from the declarations of the "
                                  "options; do not edit by hand.");
    for (const CLI::App* command : app.get_subcommands({})) {
        out += fmt::format("\n## exitance {}\n\n{}\n\n    {}\n", command->get_name(),
                           command->get_description(), usage(*command));
        std::string rows;
        for (const CLI::Option* option : command->get_options()) {
            if (option == command->get_help_ptr()) continue;
            rows += fmt::format("| `{}` | {} |\n", table_cell(option_name(*option)),
                                table_cell(option_text(*option)));
        }
        if (!rows.empty()) out += "\n| Option | What it does |\n|---|---|\n" + rows;
        if (!command->get_footer().empty())
            out += fmt::format("\n```\n{}\n```\n", command->get_footer());
    }
    return out;
}

}  // namespace exitance::cli
