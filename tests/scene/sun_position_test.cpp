// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/sun_position.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace exitance {
namespace {

constexpr double degree = std::numbers::pi / 180;

TEST(SunPosition, MeetsTheExampleOfTheSolarPositionAlgorithm) {
    // Reda & Andreas 2008 (NREL/TP-560-34302), table A5.1: 39.742476° N, 105.1786° W, 17 October
    // 2003, 12:30:30 seven hours behind: 39.872046° high before refraction, azimuth 194.340241°.
    const SunPosition sun = sun_position(39.742476, -105.1786, {2003, 10, 17, 12, 30, 30, -7});
    EXPECT_NEAR(sun.altitude / degree, 39.872046, 0.01) << "the accuracy that is stated";
    EXPECT_NEAR(sun.azimuth / degree, 194.340241, 0.01);
    EXPECT_NEAR(sun.distance, 0.9965422974, 1e-4);
    EXPECT_NEAR((Moment{2003, 10, 17, 12, 30, 30, -7}.julian_day()), 2452930.312847, 1e-6);
}

TEST(SunPosition, MeetsMeeusDeclination) {
    // Meeus 1998, example 25.a: δ = −7.78507° at 0 h dynamical time of 13 October 1992. At the pole
    // the altitude is the declination; parallax lifts nothing there by more than 0.0024°.
    const SunPosition sun = sun_position(90, 0, {1992, 10, 12, 23, 59, 1, 0});
    EXPECT_NEAR(sun.altitude / degree, -7.78507, 0.01);
}

TEST(SunPosition, NoonStandsInTheSouthAndTheEquinoxRisesInTheEast) {
    // Greenwich: the equation of time is +14.0 minutes on 11 February (sun late).
    const SunPosition noon = sun_position(51.4779, 0, {2026, 2, 11, 12, 14, 12, 0});
    EXPECT_NEAR(noon.azimuth / degree, 180, 0.1);
    const SunPosition rise = sun_position(0, 0, {2026, 3, 20, 6, 7, 30, 0});
    EXPECT_NEAR(rise.azimuth / degree, 90, 0.2);
    EXPECT_NEAR(rise.altitude / degree, 0, 0.3);
    EXPECT_EQ((Moment{2024, 12, 31}.day_of_year()), 366);
}

TEST(SunPosition, NorthTurnsCounterClockwise) {
    const SunPosition east{0, 90 * degree, 1};
    EXPECT_NEAR(length(sun_direction(east) - Vec3{1, 0, 0}), 0, 1e-12);
    // North towards −x: east is −z.
    EXPECT_NEAR(length(sun_direction(east, 90) - Vec3{0, 0, -1}), 0, 1e-12);
}

}  // namespace
}  // namespace exitance
