// SPDX-License-Identifier: Apache-2.0
// A table of a TOML file, read key by key; every error names the line and column of what is wrong.
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/run/error.h"
#include "exitance/scene/spectrum.h"

namespace exitance {

/// Parses `text`; throws Error(bad_input) with line and column for what is not TOML.
toml::table parse_toml(const std::string& file, std::string_view text);

/// Where a value of `file` stands.
Place place_of(const std::string& file, const toml::node& node);

/// What a value is called in messages: "a string", "a table".
std::string kind_of(const toml::node& node);

/// One table. `name` is what messages call it: "[[camera]]". Refers to the parsed file.
class TomlTable {
  public:
    /// Throws Error at the first key that is not among `keys`, with the nearest that is.
    TomlTable(std::string file, const toml::table& table, std::string name,
              const std::vector<std::string>& keys);

    bool has(const std::string& key) const { return table_->contains(key); }
    /// Where the value of `key` stands; where the table begins, if it has none.
    Place place(const std::string& key) const;
    Place place() const { return place_of(file_, *table_); }
    const std::string& name() const { return name_; }
    const std::string& file() const { return file_; }

    /// Throws Error at the value of `key`: "key: found …, expected `what`".
    [[noreturn]] void refuse(const std::string& key, const std::string& what) const;
    /// Throws Error if `key` is absent.
    void require(const std::string& key) const;

    // Each throws Error if the value is of another kind or out of range; absent keys give nothing.
    std::optional<std::string> text(const std::string& key) const;
    std::optional<bool> flag(const std::string& key) const;
    std::optional<double> number(const std::string& key, double least, double most) const;
    std::optional<std::uint32_t> count(const std::string& key, std::uint32_t least,
                                       std::uint32_t most) const;
    std::optional<Vec3> vector(const std::string& key) const;
    /// A number for all bands, or one per band (three), within [least, most].
    std::optional<Spectrum> spectrum(const std::string& key, double least, double most) const;
    /// `size` numbers within [least, most].
    std::optional<std::vector<double>> numbers(const std::string& key, std::size_t size,
                                               double least, double most) const;
    /// A list of points.
    std::optional<std::vector<Vec3>> points(const std::string& key) const;

    /// The tables of an array of tables [[key]].
    std::vector<const toml::table*> tables(const std::string& key) const;
    const toml::node* node(const std::string& key) const { return table_->get(key); }

  private:
    std::vector<double> numbers_of(const toml::node& node, std::size_t size, double least,
                                   double most, const std::string& key) const;

    std::string file_, name_;
    const toml::table* table_;
};

}  // namespace exitance
