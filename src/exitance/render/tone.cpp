// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/tone.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/run/error.h"

namespace exitance {

ToneCurve tone_curve(const std::string& name) {
    if (name == "linear") return ToneCurve::linear;
    if (name == "reinhard") return ToneCurve::reinhard;
    if (name == "filmic") return ToneCurve::filmic;
    throw Error(Fault::wrong_use,
                "'" + name + "' is no tone curve, expected linear, reinhard or filmic");
}

double exposure_of_ev(double ev) {
    return 1 / (1.2 * std::exp2(ev));
}

double automatic_exposure(const Image& radiance, std::span<const float> coverage) {
    std::vector<double> seen;
    for (std::size_t i = 0; i < radiance.pixels.size(); ++i)
        if (coverage[i] > 0.5f) seen.push_back(luminance(radiance.pixels[i]) / double(coverage[i]));
    if (seen.empty()) return 1;
    std::vector<double> sorted = seen;
    const auto high = sorted.begin() + std::ptrdiff_t(sorted.size() * 99 / 100);
    std::nth_element(sorted.begin(), high, sorted.end());
    const double brightest = *std::max_element(seen.begin(), seen.end());
    const double darkest = 1e-3 * (*high > 0 ? *high : brightest);
    if (!(darkest > 0)) return 1;
    double sum = 0;
    for (const double value : seen) sum += std::log(std::max(value, darkest));
    return 0.18 / std::exp(sum / static_cast<double>(seen.size()));
}

Vec3f toned(const Vec3f& colour, ToneCurve curve, double white) {
    const auto each = [&](const auto& f) {
        const auto shown = [&](float v) {
            return static_cast<float>(std::clamp(f(double(v)), 0.0, 1.0));
        };
        return Vec3f{shown(colour.x), shown(colour.y), shown(colour.z)};
    };
    switch (curve) {
        case ToneCurve::linear:
            return each([](double v) { return v; });
        case ToneCurve::reinhard: {
            const double L = luminance(colour);
            const double factor = (1 + L / (white * white)) / (1 + L);
            return each([&](double v) { return factor * v; });
        }
        case ToneCurve::filmic:
            return each(
                [](double v) { return v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14); });
    }
    return colour;
}

double white_of(const Image& radiance, double exposure) {
    double brightest = 0;
    for (const Vec3f& pixel : radiance.pixels)
        brightest = std::max(brightest, exposure * luminance(pixel));
    return std::clamp(brightest, 1.0, 4.0);
}

}  // namespace exitance
