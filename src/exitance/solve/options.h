// SPDX-License-Identifier: Apache-2.0
// What may be asked of a solve. Everything below `error` follows from it unless set.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exitance/run/options.h"

namespace exitance {

struct SolveOptions {
    double error = 0.02;
    std::optional<double> time;
    std::string solver = "shooting";
    std::string groups = "file";
    std::optional<double> unshot;
    std::optional<double> next_shot;
    std::optional<double> patch_size;
    std::optional<double> min_area;
    bool adaptive = true;
    bool merge = true;
    bool occlusion = true;
    bool overshoot = true;
    std::string form_factor = "lambert";
    int threads = 0;
    std::uint64_t seed = 0;
};

/// Every member of `options` with its name, unit, range and reason; values are read and written
/// through the result.
Options describe(SolveOptions& options);

}  // namespace exitance
