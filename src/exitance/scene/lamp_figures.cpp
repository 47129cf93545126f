// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/lamp_figures.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

constexpr std::size_t steps = 3600;  // a tenth of a degree, crossings interpolated between

LampSymmetry find_symmetry(const Photometry& p, double peak) {
    if (p.planes.size() == 1) return LampSymmetry::rotational;
    bool rotational = true, about_c0 = true, about_c90 = true;
    for (const double c : p.planes)
        for (const double gamma : p.gammas) {
            const double here = p.at(c, gamma);
            const auto same = [&](double other) {
                return std::abs(p.at(other, gamma) - here) <= 1e-3 * peak;
            };
            rotational = rotational && same(0);
            about_c0 = about_c0 && same(-c);
            about_c90 = about_c90 && same(180 - c);
        }
    if (rotational) return LampSymmetry::rotational;
    if (about_c0 && about_c90) return LampSymmetry::both;
    if (about_c0) return LampSymmetry::about_c0;
    return about_c90 ? LampSymmetry::about_c90 : LampSymmetry::none;
}

double opening_angle(const std::vector<double>& candela, double share) {
    const auto largest = std::max_element(candela.begin(), candela.end());
    if (!(*largest > 0)) return 0;
    const double level = share * *largest;
    // Turned so that the side of the largest value lies in the middle.
    const std::size_t n = candela.size() - 1,
                      at = static_cast<std::size_t>(largest - candela.begin());
    const bool below = at >= n / 4 && at <= n - n / 4;
    const auto value = [&](std::size_t i) { return candela[below ? i : (i + n / 2) % n]; };
    std::size_t first = n / 4, last = n - n / 4;
    while (first < last && value(first) < level) ++first;
    while (last > first && value(last) < level) --last;
    const auto crossing = [&](std::size_t inside, std::size_t outside) {
        const double a = value(inside), b = value(outside);
        return (a - level) / (a - b);
    };
    double width = static_cast<double>(last - first);
    if (first > n / 4) width += crossing(first, first - 1);
    if (last < n - n / 4) width += crossing(last, last + 1);
    return width * 360 / static_cast<double>(n);
}

}  // namespace

std::vector<double> profile(const Photometry& photometry, double c, std::size_t count) {
    std::vector<double> out;
    for (std::size_t i = 0; i <= count; ++i) {
        const double t = 360 * static_cast<double>(i) / static_cast<double>(count) - 180;
        out.push_back(photometry.at(t < 0 ? c + 180 : c, std::abs(t)));
    }
    return out;
}

LampFigures figures_of(const Photometry& p) {
    LampFigures out;
    out.flux = p.flux();
    out.downward = out.flux > 0 ? p.flux_below() / out.flux : 0;
    const auto largest = std::max_element(p.candela.begin(), p.candela.end());
    const auto at = static_cast<std::size_t>(largest - p.candela.begin());
    out.peak = *largest;
    out.peak_c = p.planes[at / p.gammas.size()];
    out.peak_gamma = p.gammas[at % p.gammas.size()];
    if (p.lamp_lumens && *p.lamp_lumens > 0 && !p.absolute)
        out.output_ratio = out.flux / *p.lamp_lumens;
    if (p.watts) out.efficacy = out.flux / *p.watts;
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<double> candela = profile(p, i == 0 ? 0 : 90, steps);
        out.beam[i] = opening_angle(candela, 0.5);
        out.field[i] = opening_angle(candela, 0.1);
    }
    out.symmetry = find_symmetry(p, out.peak);
    return out;
}

}  // namespace exitance
