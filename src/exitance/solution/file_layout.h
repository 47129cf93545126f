// SPDX-License-Identifier: Apache-2.0
// What the writer and the reader of solution files agree on (docs/solution-file.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "exitance/scene/scene.h"

namespace exitance::solution_file {

constexpr int format_version = 1;

/// Below this reflectance, irradiance cannot be recovered from exitance in float.
constexpr double least_invertible_reflectance = 0.02;

/// One emitter in the binary chunk: 4 × 3 doubles of corners, corner count, part.
constexpr std::size_t emitter_bytes = 12 * sizeof(double) + 2 * sizeof(std::uint32_t);

/// A group of `bands` values fills this many VEC3 attributes, the last one padded with zeros.
constexpr std::size_t attributes_per_group(std::size_t bands) {
    return (bands + 2) / 3;
}

inline std::string exitance_attribute(std::size_t index) {
    return "_EXITANCE_" + std::to_string(index);
}
inline std::string irradiance_attribute(std::size_t index) {
    return "_IRRADIANCE_" + std::to_string(index);
}

constexpr const char* unshot_attribute = "_UNSHOT";

/// B = E + ρ H cannot be solved for H accurately where ρ is near 0, nor where E outweighs ρ H, nor
/// where both vary within what a vertex stands for.
inline bool needs_irradiance(const Material& material) {
    if (material.patterned()) return true;
    for (const double rho : material.reflectance)
        if (rho < least_invertible_reflectance) return true;
    return material.emits();
}

inline std::string quantity_name(Quantity quantity) {
    return quantity == Quantity::photometric   ? "photometric"
           : quantity == Quantity::radiometric ? "radiometric"
                                               : "unitless";
}

}  // namespace exitance::solution_file
