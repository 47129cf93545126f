// SPDX-License-Identifier: Apache-2.0
// JSON that remembers where it came from: errors name line and column of the text.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "exitance/run/error.h"

namespace exitance {

/// A parsed JSON text. Paths are written as they read in messages: "meshes[0].primitives[1].mode".
class JsonText {
  public:
    /// Keeps `text` by reference. With `lines`, errors give line and column; without (text inside a
    /// binary file), the byte of the text. Throws Error for what is not JSON, and for nesting
    /// deeper than 64.
    JsonText(std::string file, std::string_view text, bool lines);

    const nlohmann::json& root() const { return *root_; }
    /// Place of the value at `path`, or of the nearest value around it that is there; for the root
    /// of a text inside a binary file, only the file. Quick for objects.
    Place place(const std::string& path) const;
    /// Throws Error at `path`: "path: message".
    [[noreturn]] void refuse(const std::string& path, const std::string& message) const;

  private:
    std::string file_;
    std::string_view text_;
    bool lines_;
    std::shared_ptr<const nlohmann::json> root_;
    std::vector<std::size_t> line_begins_;
    std::unordered_map<std::string, std::size_t> objects_;  ///< offset of every object by its path
};

/// A value of a JsonText together with its path.
struct JsonNode {
    const JsonText* text;
    const nlohmann::json* value;
    std::string path;

    [[noreturn]] void expected(const std::string& what) const;

    /// The member `key`; throws if this is no object, null `value` if it is absent.
    JsonNode member(const std::string& key) const;
    /// The member `key`, which must be there.
    JsonNode required(const std::string& key) const;
    /// Element `i` of this array.
    JsonNode element(std::size_t i) const;
    explicit operator bool() const { return value != nullptr; }

    /// Number of elements; throws if this is no array.
    std::size_t array_size() const;
    double number(double least, double most, const std::string& what) const;
    /// A whole number of [least, most].
    std::size_t whole(std::size_t least, std::size_t most, const std::string& what) const;
    /// A whole number below `count`, the number of entries of `what`.
    std::size_t index(std::size_t count, const std::string& what) const;
    const std::string& string() const;
    bool boolean() const;
    /// An array of exactly `size` finite numbers within [least, most].
    void numbers(std::size_t size, double least, double most) const;
};

}  // namespace exitance
