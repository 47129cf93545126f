// SPDX-License-Identifier: Apache-2.0
// The colour of light of a given correlated colour temperature.
#pragma once

#include "exitance/scene/spectrum.h"

namespace exitance {

/// Range of temperatures that have a colour [K].
inline constexpr double coolest_light = 25000, warmest_light = 1000;

/// Linear Rec. 709 RGB of luminance 1: a black body below 5000 K, CIE daylight from there on. Light
/// that is too saturated for the primaries, below about 1900 K, loses its negative blue.
Spectrum colour_of_temperature(double kelvin);

}  // namespace exitance
