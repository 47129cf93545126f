// SPDX-License-Identifier: Apache-2.0
// Where the sun stands, from place and time.
#pragma once

#include <cstdint>

#include "exitance/math/vector.h"

namespace exitance {

/// A moment of the Gregorian calendar, in the time of its zone.
struct Moment {
    int year = 2000, month = 1, day = 1;
    int hour = 12, minute = 0;
    double second = 0;
    double zone = 0;  ///< hours that its clocks are ahead of universal time

    /// Days since the Julian epoch, in universal time.
    double julian_day() const;
    /// Day of the year, from 1.
    int day_of_year() const;
};

struct SunPosition {
    double altitude = 0;  ///< above the horizon [rad]
    double azimuth = 0;   ///< from north over east [rad], 0 … 2π
    double distance = 1;  ///< [astronomical units]
};

/// The true direction to the middle of the sun (Meeus 1998, chapters 12, 13, 22 and 25), without
/// refraction, which lifts it by 0.03° at 30°, 0.1° at 8° and 0.5° on the horizon. Within 0.01°
/// from 1900 to 2100; the difference between universal and dynamical time is taken as 69 s.
/// `latitude`, `longitude` in degrees, north and east positive.
SunPosition sun_position(double latitude, double longitude, const Moment& moment);

/// Unit vector of the scene that points there. y is up; north is −z turned by `north` degrees,
/// counter-clockwise seen from above.
Vec3 sun_direction(const SunPosition& sun, double north = 0);

}  // namespace exitance
