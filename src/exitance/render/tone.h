// SPDX-License-Identifier: Apache-2.0
// From radiance to what a screen can show.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "exitance/math/vector.h"
#include "exitance/render/image.h"

namespace exitance {

enum class ToneCurve {
    linear,    ///< clips at 1
    reinhard,  ///< Reinhard et al. 2002, eq. 4, on luminance
    filmic     ///< fit of the ACES reference curve by Narkowicz 2015, per channel
};

/// Throws Error(wrong_use) for unknown names.
ToneCurve tone_curve(const std::string& name);

/// Rec. 709 luminance of linear RGB.
inline double luminance(const Vec3f& c) {
    return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

/// Factor that makes luminance 1.2 · 2^EV one (ISO 2720 with K = 12.5 and a lens that passes 65 %;
/// Lagarde & de Rousiers 2014, section 5.1.2).
double exposure_of_ev(double ev);

/// Factor that brings the logarithmic average of the luminances to middle grey, 0.18 (Reinhard et
/// al. 2002, eqs. 1 and 2). What no surface covers (`coverage` 0) does not count; darkness counts
/// as 1/1000 of the 99th percentile. 1 for a black picture.
double automatic_exposure(const Image& radiance, std::span<const float> coverage);

/// The luminance that the reinhard curve makes white: the brightest of the exposed picture, but at
/// most 4. Lamps may burn out; more would only grey everything else.
double white_of(const Image& radiance, double exposure);

/// Linear display value 0 … 1 of one exposed colour; `white` is what reinhard makes white.
Vec3f toned(const Vec3f& colour, ToneCurve curve, double white);

}  // namespace exitance
