// SPDX-License-Identifier: Apache-2.0
// Values per band: R, G, B in linear Rec. 709 by default, any number of spectral bands on request.
#pragma once

#include <cstddef>
#include <vector>

namespace exitance {

/// One value per band of the scene.
using Spectrum = std::vector<double>;

/// What one unit of each band adds to the luminous (or total radiant) value.
/// RGB: Rec. 709 luminance weights 0.2126, 0.7152, 0.0722; otherwise equal weights that sum to 1.
inline Spectrum luminance_weights(std::size_t bands) {
    if (bands == 3) return {0.2126, 0.7152, 0.0722};
    return Spectrum(bands, 1.0 / static_cast<double>(bands));
}

inline double luminance(const Spectrum& value) {
    const Spectrum weights = luminance_weights(value.size());
    double sum = 0;
    for (std::size_t b = 0; b < value.size(); ++b) sum += weights[b] * value[b];
    return sum;
}

}  // namespace exitance
