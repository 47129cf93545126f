// SPDX-License-Identifier: Apache-2.0
// Quantities as colours, and the legend that tells them back.
#pragma once

#include <string>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/render/image.h"

namespace exitance {

/// Linear RGB for t in 0 … 1: lightness rises evenly from dark violet over green to yellow in
/// Oklab (Ottosson 2020), so that equal steps look equal, in grey too.
Vec3f false_colour(double t);

/// Round values from `low` to `high` for the marks of a scale, about `count` of them.
std::vector<double> round_marks(double low, double high, int count);

/// A scale along the right edge of `image` (linear display values), titled, marked in numbers.
void draw_legend(Image& image, double low, double high, const std::string& title,
                 const std::string& unit);

}  // namespace exitance
