// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/cie_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exitance/math/vector.h"

namespace exitance {

namespace {

// Colour matching functions of the CIE 1931 standard colorimetric observer from 380 nm in steps of
// 10 nm (CIE 15:2004, table T.4, in four digits).
constexpr double observer_first = 380, observer_last = 780, observer_step = 10;
constexpr std::array<std::array<double, 3>, 41> observer{{
    {0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679},
    {0.0435, 0.0012, 0.2074}, {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856},
    {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721}, {0.2908, 0.0600, 1.6692},
    {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
    {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782},
    {0.1655, 0.8620, 0.0422}, {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087},
    {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021}, {0.9163, 0.8700, 0.0017},
    {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
    {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000},
    {0.2835, 0.1070, 0.0000}, {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000},
    {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000}, {0.0114, 0.0041, 0.0000},
    {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
    {0.0007, 0.0002, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000},
    {0.0001, 0.0000, 0.0000}, {0.0000, 0.0000, 0.0000},
}};

std::array<double, 3> observed(double wavelength) {
    const double at = (wavelength - observer_first) / observer_step;
    if (!(at >= 0 && at <= static_cast<double>(observer.size() - 1))) return {};
    const auto i = std::min(static_cast<std::size_t>(at), observer.size() - 2);
    const double t = at - static_cast<double>(i);
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = (1 - t) * observer[i][k] + t * observer[i + 1][k];
    return out;
}

// Longest step [nm] of the midpoint rule: no spectrum that people measure is finer.
constexpr double integration_step = 1;

using Matrix = std::array<std::array<double, 3>, 3>;

std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v) {
    std::array<double, 3> out{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) out[r] += m[r][c] * v[c];
    return out;
}

// Bradford cone responses (Lam 1985) and back.
constexpr Matrix bradford{
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
constexpr Matrix from_bradford{{{0.9869929, -0.1470543, 0.1599627},
                                {0.4323053, 0.5183603, 0.0492912},
                                {-0.0085287, 0.0400428, 0.9684867}}};
// D65, the white of Rec. 709 (ITU-R BT.709-6, 1.4), and its primaries.
constexpr std::array<double, 3> d65{0.95045593, 1, 1.08905775};
constexpr Matrix rec709{{{3.24096994, -1.53738318, -0.49861076},
                         {-0.96924364, 1.87596750, 0.04155506},
                         {0.05563008, -0.20397696, 1.05697151}}};

}  // namespace

double SampledSpectrum::at(double wavelength) const {
    if (values.size() < 2 || !(wavelength >= first && wavelength <= last)) return 0;
    const double where =
        (wavelength - first) / (last - first) * static_cast<double>(values.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(where), values.size() - 2);
    const double t = where - static_cast<double>(i);
    return (1 - t) * values[i] + t * values[i + 1];
}

Xyz xyz_of_chromaticity(double x, double y) {
    return {x / y, 1, (1 - x - y) / y};
}

namespace {

std::array<double, 3> integral(const SampledSpectrum& spectrum) {
    std::array<double, 3> sum{};
    const double from = std::max(observer_first, spectrum.first);
    const double to = std::min(observer_last, spectrum.last);
    if (!(to > from)) return sum;
    const int steps = std::max(64, static_cast<int>(std::ceil((to - from) / integration_step)));
    for (int i = 0; i < steps; ++i) {
        const double w = from + (to - from) * (i + 0.5) / steps;
        const double value = spectrum.at(w);
        const auto seen = observed(w);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += seen[k] * value * (to - from) / steps;
    }
    return sum;
}

// Rec. 709 under its white of what looks so under equal energy, but for the luminance.
std::array<double, 3> adapted_rgb(const std::array<double, 3>& xyz) {
    std::array<double, 3> cones = times(bradford, xyz);
    const auto from = times(bradford, {1, 1, 1}), to = times(bradford, d65);
    for (std::size_t k = 0; k < 3; ++k) cones[k] *= to[k] / from[k];
    return times(rec709, times(from_bradford, cones));
}

}  // namespace

Xyz xyz_of_spectrum(const SampledSpectrum& spectrum) {
    const auto sum = integral(spectrum);
    if (!(sum[1] > 0)) return {};
    // The three functions have the same area (CIE 15:2004); their four digits are nearly so.
    const auto white = integral({observer_first, observer_last, {1, 1}});
    return {sum[0] / sum[1] * white[1] / white[0], 1, sum[2] / sum[1] * white[1] / white[2]};
}

SampledSpectrum black_body(double kelvin) {
    constexpr double second_radiation_constant = 1.438776877e7;  // h c / k [nm K], CODATA 2018
    SampledSpectrum out;
    const auto exponent = [&](double w) { return second_radiation_constant / (w * kelvin); };
    // Relative to the longest wavelength seen, so that cold bodies do not underflow.
    const double reference = exponent(observer_last);
    for (double w = observer_first; w <= observer_last; w += 5) {
        const double scale = std::pow(560 / w, 5);
        out.values.push_back(scale * std::exp(reference - exponent(w)) / -std::expm1(-exponent(w)));
    }
    return out;
}

Spectrum rgb_of(const Xyz& colour) {
    const auto rgb = adapted_rgb({colour.x, colour.y, colour.z});
    Spectrum out(rgb.begin(), rgb.end());
    // Adaptation moves luminance a little; it is what was asked for.
    const double now = luminance(out);
    if (now > 0)
        for (double& band : out) band *= colour.y / now;
    return out;
}

Xyz xyz_of_rgb(const Spectrum& rgb) {
    // Cramer's rule with the images of the unit colours.
    const auto image = [](const std::array<double, 3>& colour) {
        const auto v = adapted_rgb(colour);
        return Vec3{v[0], v[1], v[2]};
    };
    const Vec3 x = image({1, 0, 0}), y = image({0, 1, 0}), z = image({0, 0, 1});
    const Vec3 wanted{rgb[0], rgb[1], rgb[2]};
    const double all = dot(x, cross(y, z));
    const Vec3 found{dot(wanted, cross(y, z)) / all, dot(x, cross(wanted, z)) / all,
                     dot(x, cross(y, wanted)) / all};
    const double scale = found.y > 0 ? luminance(rgb) / found.y : 0;
    return {found.x * scale, found.y * scale, found.z * scale};
}

double gamut_share(const Spectrum& rgb, double most) {
    const double grey = luminance(rgb);
    double share = 1;
    for (const double band : rgb) {
        if (band < 0) share = std::min(share, grey / (grey - band));
        if (band > most) share = std::min(share, std::max(0.0, most - grey) / (band - grey));
    }
    return share;
}

Spectrum toward_grey(const Spectrum& rgb, double share) {
    const double grey = luminance(rgb);
    Spectrum out = rgb;
    for (double& band : out) band = std::max(0.0, grey + share * (band - grey));
    return out;
}

Spectrum band_means(const SampledSpectrum& spectrum, double from, double to, std::size_t count) {
    constexpr int samples = 64;  // per band
    Spectrum out(count);
    const double width = (to - from) / static_cast<double>(count);
    for (std::size_t b = 0; b < count; ++b) {
        for (int i = 0; i < samples; ++i)
            out[b] += spectrum.at(from + width * (static_cast<double>(b) + (i + 0.5) / samples));
        out[b] /= samples;
    }
    return out;
}

}  // namespace exitance
