// SPDX-License-Identifier: Apache-2.0
// Adaptive subdivision: elements are split where their light is not what interpolation between
// their corners says.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
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
    /// Beside a penumbra the rays of a point may agree by chance: no point of an element is taken
    /// to know better than its most uncertain one.
    bool shared_noise = false;
    /// Small elements are divided all the same where they are wrong by so many times what would be
    /// their share in the square error of the whole; a few such do not count.
    float gross = INFINITY;
    /// Per patch: what the tolerance is divided by, 0 = the patch stays as it is; empty: all alike.
    std::span<const float> importance{};
    std::size_t most_vertices = SIZE_MAX;  ///< the mesh is not divided beyond these
    std::function<bool()> interrupted{};   ///< true: the mesh stays as it is so far
};

/// What counts is the sum over elements of error² × area: each may contribute the same, so one of
/// `area` may be wrong by `tolerance` × √(`whole` / `area`), but no place may be very wrong.
inline float tolerance_of(float tolerance, float whole, float area) {
    constexpr float most = 8;
    return tolerance * std::clamp(std::sqrt(whole / area), 1.0f, most);
}

/// Lights any receivers with everything that has been shot so far, into a reset `Received`.
/// Returns rays cast.
using Illuminate = std::function<std::uint64_t(const Receivers&, Received&)>;

/// Splits leaves until their irradiance interpolates within the tolerance or they are small. New
/// vertices are given all the light shot so far by evaluating it, none by interpolation (why:
/// docs/design.md). Returns rays cast.
std::uint64_t refine(Radiosity& radiosity, const RefineOptions& options,
                     const Illuminate& illuminate);

}  // namespace exitance
