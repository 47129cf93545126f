// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/sun_position.h"

#include <cmath>
#include <numbers>

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

// The days before a date of the Gregorian calendar (Meeus 1998, eq. 7.1).
double julian_day_at_midnight(int year, int month, int day) {
    if (month <= 2) --year, month += 12;
    const double century = std::floor(year / 100.0);
    return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + 2 -
           century + std::floor(century / 4) - 1524.5;
}

double turned_into_circle(double angle) {
    const double rest = std::fmod(angle, 2 * pi);
    return rest < 0 ? rest + 2 * pi : rest;
}

}  // namespace

double Moment::julian_day() const {
    const double hours = hour + minute / 60.0 + second / 3600 - zone;
    return julian_day_at_midnight(year, month, day) + hours / 24;
}

int Moment::day_of_year() const {
    return static_cast<int>(std::lround(julian_day_at_midnight(year, month, day) -
                                        julian_day_at_midnight(year, 1, 1))) +
           1;
}

SunPosition sun_position(double latitude, double longitude, const Moment& moment) {
    constexpr double dynamical_minus_universal = 69.0 / 86400;  // [days], of the 2020s
    const double universal = moment.julian_day() - 2451545.0;
    const double T = (universal + dynamical_minus_universal) / 36525;

    // Chapter 25, low accuracy: mean longitude, mean anomaly, eccentricity, equation of the centre.
    const double L0 = 280.46646 + T * (36000.76983 + T * 0.0003032);
    const double M = (357.52911 + T * (35999.05029 - T * 0.0001537)) * degree;
    const double e = 0.016708634 - T * (0.000042037 + T * 0.0000001267);
    const double C = (1.914602 - T * (0.004817 + T * 0.000014)) * std::sin(M) +
                     (0.019993 - T * 0.000101) * std::sin(2 * M) + 0.000289 * std::sin(3 * M);
    const double R = 1.000001018 * (1 - e * e) / (1 + e * std::cos(M + C * degree));

    // Apparent longitude and obliquity: nutation and aberration.
    const double node = (125.04 - 1934.136 * T) * degree;
    const double longitude_of_sun = (L0 + C - 0.00569 - 0.00478 * std::sin(node)) * degree;
    const double mean_obliquity =
        23.439291111 - T * (0.013004167 + T * (1.64e-7 - T * 5.04e-7));  // eq. 22.2
    const double obliquity = (mean_obliquity + 0.00256 * std::cos(node)) * degree;
    const double alpha =
        std::atan2(std::cos(obliquity) * std::sin(longitude_of_sun), std::cos(longitude_of_sun));
    const double delta = std::asin(std::sin(obliquity) * std::sin(longitude_of_sun));

    // Apparent sidereal time of the place (eq. 12.4), hour angle, horizontal coordinates (13.5, 6).
    const double sidereal = 280.46061837 + 360.98564736629 * universal + 0.000387933 * T * T -
                            0.00478 * std::sin(node) * std::cos(obliquity) + longitude;
    const double H = sidereal * degree - alpha;
    const double phi = latitude * degree;
    const double altitude =
        std::asin(std::sin(phi) * std::sin(delta) + std::cos(phi) * std::cos(delta) * std::cos(H));
    const double azimuth = std::atan2(
        std::sin(H), std::cos(H) * std::sin(phi) - std::tan(delta) * std::cos(phi));  // from south

    SunPosition out;
    // From the surface instead of the middle of the earth: a parallax of 8.794″ (chapter 40).
    out.altitude = altitude - 8.794 / 3600 * degree * std::cos(altitude) / R;
    out.azimuth = turned_into_circle(azimuth + pi);
    out.distance = R;
    return out;
}

Vec3 sun_direction(const SunPosition& sun, double north) {
    // East is a quarter turn clockwise of north, which −z is at 0.
    const double clockwise = sun.azimuth - north * degree;
    return {std::cos(sun.altitude) * std::sin(clockwise), std::sin(sun.altitude),
            -std::cos(sun.altitude) * std::cos(clockwise)};
}

}  // namespace exitance
