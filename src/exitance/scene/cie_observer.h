// SPDX-License-Identifier: Apache-2.0
// From spectra and chromaticities to the bands of a scene: CIE 1931 standard observer, linear
// Rec. 709.
#pragma once

#include <vector>

#include "exitance/scene/spectrum.h"

namespace exitance {

/// CIE 1931 tristimulus values; y is luminance.
struct Xyz {
    double x = 0, y = 0, z = 0;

    friend bool operator==(const Xyz&, const Xyz&) = default;
};

/// Values at evenly spaced wavelengths from `first` to `last` [nm], linear in between, zero
/// outside. At least two values.
struct SampledSpectrum {
    double first = 380, last = 780;
    std::vector<double> values;

    double at(double wavelength) const;
};

/// Of luminance 1, with chromaticity (x, y); y must be positive.
Xyz xyz_of_chromaticity(double x, double y);
/// Of luminance 1 (black where the observer sees nothing); the scale of `spectrum` does not count.
Xyz xyz_of_spectrum(const SampledSpectrum& spectrum);
/// A black body at `kelvin` by Planck's law, of any scale.
SampledSpectrum black_body(double kelvin);

/// Linear Rec. 709 with equal energy, x = y = 1/3, as white (adapted by the Bradford transform):
/// what reflects all wavelengths alike has three equal bands. Luminance is kept; colours that RGB
/// cannot show have negative bands.
Spectrum rgb_of(const Xyz& colour);
/// The colour that rgb_of() shows as `rgb`; of the same luminance.
Xyz xyz_of_rgb(const Spectrum& rgb);
/// How far the bands of `rgb` can move from grey of the same luminance before one leaves
/// [0, `most`]: 1 = as they are, 0 = grey.
double gamut_share(const Spectrum& rgb, double most);
/// `share` of the way from grey of the same luminance to `rgb`.
Spectrum toward_grey(const Spectrum& rgb, double share);

/// Mean of `spectrum` over each of `count` bands of equal width between two wavelengths [nm].
Spectrum band_means(const SampledSpectrum& spectrum, double from, double to, std::size_t count);

}  // namespace exitance
