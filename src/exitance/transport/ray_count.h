// SPDX-License-Identifier: Apache-2.0
// How many shadow rays a receiver deserves, and what error they leave. One law for polygons,
// luminaires and the sun.
#pragma once

#include <algorithm>
#include <cmath>

namespace exitance {

/// Stratified samples of a penumbra miss by about n^-3/4 / 2 of the contribution c (in units of the
/// tolerance): n = (2 c)^4/3 brings that to a quarter of the tolerance. Fainter sources get one
/// ray: their errors are independent and average out over the many of them.
template <class Real>
Real rays_for(Real contribution, Real most = Real(256)) {
    if (!(contribution > Real(0.5))) return Real(1);
    return std::clamp(std::ceil(std::pow(Real(2) * contribution, Real(4.0 / 3.0))), Real(1), most);
}

/// Standard deviation to expect of the visible share of a penumbra after `samples`.
inline float penumbra_deviation(double samples) {
    return static_cast<float>(0.5 * std::pow(samples, -0.75));
}

}  // namespace exitance
