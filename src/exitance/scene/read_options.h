// SPDX-License-Identifier: Apache-2.0
// What may be asked of reading a scene: how strict, how finely curved, how much at most.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "exitance/run/options.h"

namespace exitance {

struct ReadOptions {
    bool strict = false;
    double tolerance = 0.02;
    std::uint64_t max_include_depth = 32;
    std::uint64_t max_files = 10'000;
    double max_file_size = 1024;
    std::uint64_t max_polygons = 20'000'000;
    std::uint64_t max_corners = 10'000;
    std::uint64_t max_lines = 20'000'000;
    std::uint64_t max_texture_pixels = 16384 * 8192;
    std::uint64_t max_luminaires = 100'000;

    /// Where files lie that the scene names, if it is itself named by another: the folder of the
    /// first file. The first, which is the user's own, may name any.
    std::optional<std::filesystem::path> held_in{};

    /// max_file_size [bytes].
    std::uint64_t most_bytes() const {
        return static_cast<std::uint64_t>(max_file_size * 1024 * 1024);
    }
};

/// Every member of `options` with its name, unit, range and reason; values are read and written
/// through the result.
Options describe(ReadOptions& options);

}  // namespace exitance
