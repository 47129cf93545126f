// SPDX-License-Identifier: Apache-2.0
// Irradiance of the Cornell box by brute force, stored beside this file because it takes minutes:
// the green band at the centres of the 64 × 64 points of the grids "floor" and "back".
#pragma once

#include <filesystem>
#include <vector>

#include "truth/path_tracer.h"

namespace exitance::truth {

/// What the stored values were made with.
inline constexpr Effort cornell_effort{1024, 16, 7};
inline constexpr std::size_t green = 1;

/// The points: both grids of cornell_box(), row by row.
std::vector<Receiver> cornell_receivers();

/// One value per receiver [W/m²].
struct CornellTruth {
    std::vector<double> mean, standard_error;
};

std::filesystem::path cornell_truth_path();
/// Throws Error if the file is not as write_cornell_truth() leaves it.
CornellTruth read_cornell_truth();
void write_cornell_truth(const CornellTruth& truth, const std::filesystem::path& path);

}  // namespace exitance::truth
