// SPDX-License-Identifier: Apache-2.0
// The error of low-discrepancy sampling, from sequences scrambled independently (randomised
// quasi-Monte Carlo; Owen 1995): each batch is an unbiased estimate of its own.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace exitance {

inline constexpr std::size_t batches = 8;

/// Standard error of the mean of the batches.
inline double standard_error(const std::array<double, batches>& values) {
    double mean = 0, squares = 0;
    for (const double v : values) mean += v / double(batches);
    for (const double v : values) squares += (v - mean) * (v - mean);
    return std::sqrt(squares / double(batches * (batches - 1)));
}

}  // namespace exitance
