// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/math/warp.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;

struct Coefficients {
    double a, b, c, d, e;
};

// ISO 15469:2004, table 1.
constexpr std::array<Coefficients, 15> cie{{{4.0, -0.70, 0, -1.0, 0},
                                            {4.0, -0.70, 2, -1.5, 0.15},
                                            {1.1, -0.8, 0, -1.0, 0},
                                            {1.1, -0.8, 2, -1.5, 0.15},
                                            {0, -1.0, 0, -1.0, 0},
                                            {0, -1.0, 2, -1.5, 0.15},
                                            {0, -1.0, 5, -2.5, 0.30},
                                            {0, -1.0, 10, -3.0, 0.45},
                                            {-1.0, -0.55, 2, -1.5, 0.15},
                                            {-1.0, -0.55, 5, -2.5, 0.30},
                                            {-1.0, -0.55, 10, -3.0, 0.45},
                                            {-1.0, -0.32, 10, -3.0, 0.45},
                                            {-1.0, -0.32, 16, -3.0, 0.30},
                                            {-1.0, -0.15, 16, -3.0, 0.30},
                                            {-1.0, -0.15, 24, -2.8, 0.15}}};

// Perez, Seals & Michalsky 1993, table 1: x1 … x4 of a, b, c, d, e per range of clearness.
constexpr double perez[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                    {-0.7670, 0.0007, 1.2734, -0.1233},
                                    {2.8000, 0.6004, 1.2375, 1.0000},
                                    {1.8734, 0.6297, 0.9738, 0.2809},
                                    {0.0356, -0.1246, -0.5718, 0.9938}},
                                   {{-1.2219, -0.7730, 1.4148, 1.1016},
                                    {-0.2054, 0.0367, -3.9128, 0.9156},
                                    {6.9750, 0.1774, 6.4477, -0.1239},
                                    {-1.5798, -0.5081, -1.7812, 0.1080},
                                    {0.2624, 0.0672, -0.2190, -0.4285}},
                                   {{-1.1000, -0.2515, 0.8952, 0.0156},
                                    {0.2782, -0.1812, -4.5000, 1.1766},
                                    {24.7219, -13.0812, -37.7000, 34.8438},
                                    {-5.0000, 1.5218, 3.9229, -2.6204},
                                    {-0.0156, 0.1597, 0.4199, -0.5562}},
                                   {{-0.5484, -0.6654, -0.2672, 0.7117},
                                    {0.7234, -0.6219, -5.6812, 2.6297},
                                    {33.3389, -18.3000, -62.2500, 52.0781},
                                    {-3.5000, 0.0016, 1.1477, 0.1062},
                                    {0.4659, -0.3296, -0.0876, -0.0329}},
                                   {{-0.6000, -0.3566, -2.5000, 2.3250},
                                    {0.2937, 0.0496, -5.6812, 1.8415},
                                    {21.0000, -4.7656, -21.5906, 7.2492},
                                    {-3.5000, -0.1554, 1.4062, 0.3988},
                                    {0.0032, 0.0766, -0.0656, -0.1294}},
                                   {{-1.0156, -0.3670, 1.0078, 1.4051},
                                    {0.2875, -0.5328, -3.8500, 3.3750},
                                    {14.0000, -0.9999, -7.1406, 7.5469},
                                    {-3.4000, -0.1078, -1.0750, 1.5702},
                                    {-0.0672, 0.4016, 0.3017, -0.4844}},
                                   {{-1.0000, 0.0211, 0.5025, -0.5119},
                                    {-0.3000, 0.1922, 0.7023, -1.6317},
                                    {19.0000, -5.0000, 1.2438, -1.9094},
                                    {-4.0000, 0.0250, 0.3844, 0.2656},
                                    {1.0468, -0.3788, -2.4517, 1.4656}},
                                   {{-1.0500, 0.0289, 0.4260, 0.3590},
                                    {-0.3250, 0.1156, 0.7781, 0.0025},
                                    {31.0625, -14.5000, -46.1148, 55.3750},
                                    {-7.2312, 0.4050, 13.3500, 0.6234},
                                    {1.5000, -0.6426, 1.8564, 0.5636}}};

// Perez et al. 1990, table 1: upper ends of the ranges of clearness.
constexpr std::array<double, 7> clearness_ends{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

// Perez et al. 1990, table 4: a + b W + c cos Z + d ln Δ, and a + b W + c exp(5.73 Z − 5) + d Δ.
constexpr double diffuse_efficacy[8][4] = {
    {97.24, -0.46, 12.00, -8.91},   {107.22, 1.15, 0.59, -3.95},    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.90}, {100.71, 5.94, -22.75, -23.74}, {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.90, -53.24, -14.03}, {152.23, 0.35, -45.27, -7.98}};
constexpr double direct_efficacy[8][4] = {
    {57.20, -4.55, -2.98, 117.12}, {98.99, -3.46, -1.21, 12.38},  {109.83, -4.90, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56}, {106.36, -3.97, -1.75, -6.16}, {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44}, {101.18, 1.58, -1.10, -8.29}};

std::size_t clearness_range(double clearness) {
    return static_cast<std::size_t>(
        std::upper_bound(clearness_ends.begin(), clearness_ends.end(), clearness) -
        clearness_ends.begin());
}

}  // namespace

double SkyModel::luminance(const Vec3& direction) const {
    if (!(direction.y > 0)) return 0;
    if (traditional_overcast) return scale * (1 + 2 * direction.y) / 3;
    // The gradation of some models has no limit at the horizon: half a degree above it will do.
    const double cosine = std::max(direction.y, 0.01);
    const double gradation = 1 + a * std::exp(b / cosine);
    const double to_sun = std::clamp(dot(direction, sun), -1.0, 1.0);
    const double scattering =
        1 + c * (std::exp(d * std::acos(to_sun)) - circumsolar_offset * std::exp(d * pi / 2)) +
        e * to_sun * to_sun;
    return scale * std::max(0.0, gradation * scattering);
}

SkyModel cie_sky(int type) {
    SkyModel out;
    if (type == 16) {
        out.traditional_overcast = true;
        return out;
    }
    const Coefficients& k = cie[static_cast<std::size_t>(std::clamp(type, 1, 15) - 1)];
    out.a = k.a, out.b = k.b, out.c = k.c, out.d = k.d, out.e = k.e;
    return out;
}

SkyConditions sky_conditions(const MeasuredDaylight& measured, double altitude, int day_of_year) {
    const double zenith = pi / 2 - altitude;
    SkyConditions out;
    const double k = 1.041 * zenith * zenith * zenith;
    const double diffuse = std::max(measured.diffuse_horizontal, 1e-9);
    out.clearness = ((diffuse + measured.direct_normal) / diffuse + k) / (1 + k);
    // Relative optical air mass (Kasten & Young 1989), and the irradiance outside of the
    // atmosphere.
    const double degrees = altitude * 180 / pi;
    const double mass = 1 / (std::sin(altitude) + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
    const double outside = 1367 * (1 + 0.033 * std::cos(2 * pi * day_of_year / 365));
    out.brightness = std::clamp(diffuse * mass / outside, 0.01, 0.6);
    return out;
}

SkyModel perez_sky(const SkyConditions& conditions, double altitude) {
    const double Z = pi / 2 - altitude;
    // The authors' note on small brightness at high clearness.
    double delta = conditions.brightness;
    if (conditions.clearness > 1.065 && conditions.clearness < 2.8) delta = std::max(delta, 0.2);
    const std::size_t range = clearness_range(conditions.clearness);
    const auto x = [&](std::size_t letter) {
        const double* k = perez[range][letter];
        return k[0] + k[1] * Z + delta * (k[2] + k[3] * Z);
    };
    SkyModel out;
    out.circumsolar_offset = 0;
    out.a = x(0), out.b = x(1), out.c = x(2), out.d = x(3), out.e = x(4);
    if (range == 0) {  // eqs. 7 and 8
        const double *c = perez[0][2], *d = perez[0][3];
        out.c = std::exp(std::pow(delta * (c[0] + c[1] * Z), c[2])) - c[3];
        out.d = -std::exp(delta * (d[0] + d[1] * Z)) + d[2] + delta * d[3];
    }
    return out;
}

DaylightEfficacy daylight_efficacy(const SkyConditions& conditions, double altitude) {
    constexpr double water = 2;
    const double Z = pi / 2 - altitude;
    const std::size_t range = clearness_range(conditions.clearness);
    const double *f = diffuse_efficacy[range], *d = direct_efficacy[range];
    return {std::max(0.0, d[0] + d[1] * water + d[2] * std::exp(5.73 * Z - 5) +
                              d[3] * conditions.brightness),
            f[0] + f[1] * water + f[2] * std::cos(Z) + f[3] * std::log(conditions.brightness)};
}

std::array<double, 3> RadianceMap::radiance(const Vec3& direction) const {
    const DirectionPlace place = place_of(direction);
    const std::uint32_t n = side();
    const auto column = std::min(n - 1, static_cast<std::uint32_t>(place.u * n));
    const auto row = std::min(n - 1, static_cast<std::uint32_t>(place.v * n));
    const float* cell = &cells[((std::size_t{place.lower} * n + row) * n + column) * 3];
    return {double(cell[0]), double(cell[1]), double(cell[2])};
}

namespace {

struct SineCosine {
    double sine, cosine;
};

// Taylor's series; between -pi/4 and pi/4 what is left out is below 3e-14. The library's functions
// took a third of the time of a solve under a sky.
SineCosine sine_cosine(double x) {
    const double y = x * x;
    const double sine =
        1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110 * (1 - y / 156)))));
    const double cosine =
        1 - y / 2 * (1 - y / 12 * (1 - y / 30 * (1 - y / 56 * (1 - y / 90 * (1 - y / 132)))));
    return {x * sine, cosine};
}

}  // namespace

Vec3 direction_of(const DirectionPlace& place) {
    const double a = 2 * place.u - 1, b = 2 * place.v - 1;
    double r = 0, x = 1, z = 0;
    if (std::abs(a) > std::abs(b)) {
        r = a;
        const auto [sine, cosine] = sine_cosine(pi / 4 * b / a);
        x = cosine, z = sine;
    } else if (b != 0) {
        r = b;
        const auto [sine, cosine] = sine_cosine(pi / 4 * a / b);
        x = sine, z = cosine;
    }
    const double height = std::max(0.0, 1 - r * r), across = r * std::sqrt(2 - r * r);
    return {across * x, place.lower ? -height : height, across * z};
}

DirectionPlace place_of(const Vec3& direction) {
    const double across = std::hypot(direction.x, direction.z);
    const double r = std::sqrt(std::max(0.0, 1 - std::abs(direction.y)));
    double a = 0, b = 0;
    if (across > 0) {
        const double x = direction.x / across, z = direction.z / across;
        if (std::abs(x) > std::abs(z)) {
            a = std::copysign(r, x);
            b = a * std::atan(z / x) * 4 / pi;
        } else {
            b = std::copysign(r, z);
            a = b * std::atan(x / z) * 4 / pi;
        }
    }
    return {direction.y < 0, std::clamp(0.5 * (a + 1), 0.0, 1.0),
            std::clamp(0.5 * (b + 1), 0.0, 1.0)};
}

}  // namespace exitance
