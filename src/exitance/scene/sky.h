// SPDX-License-Identifier: Apache-2.0
// The luminance of the sky over its directions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

/// L(Z, χ) = scale · φ(Z) f(χ) above the horizon, Z the angle from the zenith, χ that from the sun.
struct SkyModel {
    /// φ = 1 + a exp(b / cos Z), f = 1 + c (exp(dχ) − exp(dπ/2)) + e cos²χ (ISO 15469:2004, eq.
    /// 1–7; Perez, Seals & Michalsky 1993 without the constant of c). All zero: uniform.
    double a = 0, b = -1, c = 0, d = -1, e = 0;
    bool traditional_overcast = false;  ///< φ = (1 + 2 cos Z) / 3 (Moon & Spencer 1942), f = 1
    double circumsolar_offset = 1;      ///< factor of exp(dπ/2): 1 CIE, 0 Perez
    double scale = 1;                   ///< [cd/m², or W/(m² sr)]
    Vec3 sun{0, 1, 0};                  ///< unit, where the sun stands, also behind clouds

    /// Luminance along `direction`, unit, y up; 0 below the horizon.
    double luminance(const Vec3& direction) const;
};

/// The CIE standard general skies by their number, 1 … 15 (ISO 15469:2004, table 1): 1 standard
/// overcast, 5 uniform, 12 standard clear, 13 clear and polluted. 16 is the traditional overcast
/// sky. `scale` 1; `sun` is left to the caller.
SkyModel cie_sky(int type);

/// Irradiances in W/m².
struct MeasuredDaylight {
    double direct_normal = 0, diffuse_horizontal = 0;
};
/// ε and Δ of Perez et al. 1990, eqs. 1 and 2.
struct SkyConditions {
    double clearness = 1, brightness = 0.2;
};
/// `altitude` of the sun [rad], above 0.
SkyConditions sky_conditions(const MeasuredDaylight& measured, double altitude, int day_of_year);
/// Perez, Seals & Michalsky 1993, table 1. `scale` 1.
SkyModel perez_sky(const SkyConditions& conditions, double altitude);
/// Luminous efficacy of the measured light [lm/W] (Perez et al. 1990, table 4), for 2 cm of
/// precipitable water.
struct DaylightEfficacy {
    double direct = 0, diffuse = 0;
};
DaylightEfficacy daylight_efficacy(const SkyConditions& conditions, double altitude);

/// Radiance of all directions on cells of equal solid angle: two squares of 2^level × 2^level
/// cells, the upper (y > 0) and the lower hemisphere, three bands.
struct RadianceMap {
    std::uint32_t level = 0;
    std::vector<float> cells;  ///< ((hemisphere · n + row) · n + column) · 3 + band

    std::uint32_t side() const { return 1u << level; }
    /// Of the cell that `direction` falls into.
    std::array<double, 3> radiance(const Vec3& direction) const;
};

/// The two squares that the directions are mapped to, areas in proportion: place (u, v) in [0, 1]²
/// of the upper or the lower square (Shirley & Chiu 1997 and Lambert's equal-area map).
struct DirectionPlace {
    bool lower = false;
    double u = 0, v = 0;
};
Vec3 direction_of(const DirectionPlace& place);
DirectionPlace place_of(const Vec3& direction);

}  // namespace exitance
