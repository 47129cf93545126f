// SPDX-License-Identifier: Apache-2.0
// An option is declared once: name, where it is stored (its default is what stands there), unit,
// range and reason. The command line's --help, the keys of TOML files and docs/manual.md all come
// from this declaration.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace exitance {

struct Option {
    using Target = std::variant<bool*, int*, std::uint64_t*, double*, std::optional<double>*,
                                std::string*, std::optional<std::string>*>;

    std::string name;    ///< as typed, without dashes: "error"
    Target target;       ///< the variable that receives the value
    std::string what;    ///< one line: what it sets, and why one would change it
    std::string unit{};  ///< "m²", "s", "" for pure numbers
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    std::vector<std::string> choices{};  ///< for strings: the only values allowed

    /// The value that is stored now, as a reader would type it; "" if unset.
    std::string value_text() const;
    /// "0.0001 … 1", "one of a, b", or "" if anything goes.
    std::string range_text() const;
    bool is_flag() const { return std::holds_alternative<bool*>(target); }

    /// Parses and stores `text`. Throws Error(wrong_use) that names the option and what it takes.
    void set(const std::string& text) const;
    /// Throws Error(wrong_use) if the number is not finite or outside [least, most].
    void check(double value) const;
};

using Options = std::vector<Option>;

/// The option called `name`; throws Error(wrong_use) with a suggestion if there is none.
const Option& find_option(const Options& options, const std::string& name);

}  // namespace exitance
