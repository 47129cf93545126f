// SPDX-License-Identifier: Apache-2.0
// Adaptive subdivision: elements are split where their light is not what interpolation between
// their corners says.
#pragma once

#include <functional>
#include <vector>

#include "exitance/solve/cast_light.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

struct RefineOptions {
    float tolerance = 0;  ///< irradiance (luminance) that may be wrong in an element of `area`
    float area = 1;       ///< [m²]; smaller elements may be wrong by more
    float min_area = 0;   ///< elements below this area stay [m²]
    /// Test every patch that gets light, not only those whose corners differ: something small may
    /// throw its shadow between them.
    bool thorough = false;
    std::function<bool()> interrupted{};  ///< true: the mesh stays as it is so far
};

/// Lights any receivers with everything that has been shot so far, into a reset `Received`.
/// Returns rays cast.
using Illuminate = std::function<std::uint64_t(const Receivers&, Received&)>;

/// Splits leaves until their irradiance interpolates within the tolerance or they are small. New
/// vertices are given all the light shot so far by evaluating it, none by interpolation (why:
/// docs/design.md). Returns rays cast.
std::uint64_t refine(Radiosity& radiosity, const RefineOptions& options,
                     const Illuminate& illuminate);

}  // namespace exitance
