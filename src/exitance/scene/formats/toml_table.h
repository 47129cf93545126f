// SPDX-License-Identifier: Apache-2.0
// A table of a TOML file, read key by key; every error names the line and column of what is wrong.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/run/error.h"
#include "exitance/scene/spectrum.h"
#include "exitance/scene/sun_position.h"

namespace toml {
inline namespace v3 {
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace exitance {

/// One table. `name` is what messages call it: "[[camera]]". Shares the parsed file.
class TomlTable {
  public:
    /// The root of a file. Throws Error(bad_input) with line and column for what is not TOML, and
    /// at the first key that is not among `keys`, with the nearest that is.
    static TomlTable parse(const std::string& file, std::string_view text, const std::string& name,
                           const std::vector<std::string>& keys);

    /// The table [key], which may have `keys`.
    std::optional<TomlTable> table(const std::string& key,
                                   const std::vector<std::string>& keys) const;
    /// The tables of an array of tables [[key]], which may have `keys`.
    std::vector<TomlTable> tables(const std::string& key,
                                  const std::vector<std::string>& keys) const;

    /// A key of a table that may have any, its value as text.
    struct Scalar {
        std::string name, value;
        Place place;
    };
    /// The words, numbers and flags of the table [key].
    std::vector<Scalar> scalars(const std::string& key) const;
    /// The same of every table of the array [[key]], with where it begins.
    std::vector<std::pair<Place, std::vector<Scalar>>> scalar_tables(const std::string& key) const;

    bool has(const std::string& key) const { return node(key) != nullptr; }
    bool is_number(const std::string& key) const;
    bool is_array(const std::string& key) const;
    /// Where the value of `key` stands; where the table begins, if it has none.
    Place place(const std::string& key) const;
    Place place() const;
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
    /// A date and time of day; its offset from universal time, if it has one, as the zone.
    struct Time {
        Moment moment;
        bool has_zone = false;
    };
    std::optional<Time> time(const std::string& key) const;
    /// A list of points.
    std::optional<std::vector<Vec3>> points(const std::string& key) const;

  private:
    std::vector<Scalar> scalars_of(const toml::table& table) const;
    TomlTable(std::string file, std::shared_ptr<const toml::table> table, std::string name,
              const std::vector<std::string>& keys);
    const toml::node* node(const std::string& key) const;
    std::vector<double> numbers_of(const toml::node& node, std::size_t size, double least,
                                   double most, const std::string& key) const;

    std::string file_, name_;
    std::shared_ptr<const toml::table> table_;
};

}  // namespace exitance
