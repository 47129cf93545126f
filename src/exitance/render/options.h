// SPDX-License-Identifier: Apache-2.0
// What may be asked of a picture.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "exitance/run/options.h"

namespace exitance {

struct RenderOptions {
    std::optional<std::string> size{};
    int samples = 16;
    std::string tone = "reinhard";
    std::optional<double> ev{};
    std::optional<std::string> false_colour{};
    bool wireframe = false;
    bool normals = false;
    std::uint64_t seed = 0;

    /// Values at the two ends of the false colours; default: 0 and what 99 % of the picture
    /// stays below.
    std::optional<std::array<double, 2>> range{};
    /// Weights of light groups by name, instead of those in the solution.
    std::map<std::string, double> group_weights{};
};

/// Every member of `options` that is one value, with its name, unit, range and reason.
Options describe(RenderOptions& options);

struct ImageSize {
    std::uint32_t width, height;
};

/// "1280x720". Throws Error(wrong_use) for anything else, and beyond 16384 either way.
ImageSize parse_size(const std::string& text);

}  // namespace exitance
