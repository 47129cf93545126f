// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/builtin_photometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

Photometry isotropic_photometry() {
    Photometry out;
    out.planes = {0};
    out.gammas = {0, 180};
    out.candela = {1, 1};
    return out;
}

Photometry spot_photometry(double beam, double field) {
    constexpr std::size_t steps = 360;
    constexpr double darkest = 1e-4;  // is left out, beyond the last angle
    constexpr double ln2 = std::numbers::ln2;
    const double p = std::log(std::log(10) / ln2) / std::log(field / beam);
    const double last = std::min(180.0, beam / 2 * std::pow(-std::log(darkest) / ln2, 1 / p));
    Photometry out;
    out.planes = {0};
    for (std::size_t i = 0; i <= steps; ++i) {
        const double gamma = last * static_cast<double>(i) / steps;
        out.gammas.push_back(gamma);
        out.candela.push_back(std::exp(-ln2 * std::pow(2 * gamma / beam, p)));
    }
    return out;
}

Photometry mirrored(const Photometry& photometry) {
    Photometry out = photometry;
    const std::size_t n = photometry.gammas.size(), planes = photometry.planes.size();
    for (std::size_t i = 0; i < planes && planes > 1; ++i) {
        const std::size_t from = planes - 1 - i;
        out.planes[i] = 360 - photometry.planes[from];
        std::copy_n(photometry.candela.begin() + static_cast<std::ptrdiff_t>(from * n), n,
                    out.candela.begin() + static_cast<std::ptrdiff_t>(i * n));
    }
    std::swap(out.opening.sides[1], out.opening.sides[3]);
    return out;
}

}  // namespace exitance
