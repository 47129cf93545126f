// SPDX-License-Identifier: Apache-2.0
// The parts of a solution that live in the JSON of its file, in both directions.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "exitance/solution/solution.h"

namespace exitance::solution_file {

/// Everything but vertices, triangles, parts, materials and emitters: asset.extras.exitance.
nlohmann::json extras_of(const Solution& solution);
nlohmann::json extras_of(const Material& material);

/// A value inside the JSON of a file, with its path for messages. Every access is checked and
/// throws Error(bad_input) that says where, what was found and what was expected.
class Node {
  public:
    Node(const std::string& file, const nlohmann::json& value, std::string path = "")
        : file_(&file), value_(&value), path_(std::move(path)) {}

    [[noreturn]] void refuse(const std::string& expected) const;

    Node operator[](const std::string& key) const;
    Node operator[](std::size_t index) const;
    bool has(const std::string& key) const;
    /// Number of entries of an array.
    std::size_t size() const;
    /// The keys of an object.
    std::vector<std::string> keys() const;

    double number() const;
    double number_within(double least, double most) const;
    std::uint64_t index_below(std::uint64_t limit) const;
    std::uint64_t count() const;
    const std::string& text() const;
    bool flag() const;
    Vec3 vector() const;
    Spectrum spectrum(std::size_t bands, double most) const;

  private:
    const std::string* file_;
    const nlohmann::json* value_;
    std::string path_;
};

/// Fills what extras_of(Solution) stored.
void read_extras(const Node& extras, Solution& solution);
Material read_material(const Node& material, std::size_t bands);

}  // namespace exitance::solution_file
