// SPDX-License-Identifier: Apache-2.0
// What every reader accepts at most.
#pragma once

#include <cstdint>

namespace exitance::limits {

/// Coordinates are stored in float later on; beyond this nothing in a building is meant [m].
inline constexpr double coordinate = 1e9;
/// Lengths that must not be zero [m].
inline constexpr double length = 1e-9;
/// Emitted exitance per band; well inside float after multiplication by areas.
inline constexpr double exitance = 1e20;
/// Shooting patches of one polygon. A prime number of them stands in one row, and places in it are
/// 32-bit multiples of 2^-12 patches, of which two are added.
inline constexpr std::uint32_t patches = 250'000;
/// Points, and polygons, of one scene.
inline constexpr std::uint32_t elements = 1U << 27;

}  // namespace exitance::limits
