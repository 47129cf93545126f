// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/preview.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

double luminance(const Vec3f& c) {
    return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

}  // namespace

PreviewTone preview_tone(std::span<const Vec3f> colours, std::span<const float> areas) {
    double brightest = 0;
    for (const Vec3f& c : colours) brightest = std::max(brightest, luminance(c));
    if (!(brightest > 0)) return {};
    // Darkness counts as 1e-4 of the brightest, so that unlit rooms next door do not blind.
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const double area = double(areas[i]);
        sum += area * std::log(std::max(luminance(colours[i]), 1e-4 * brightest));
        weight += area;
    }
    if (!(weight > 0)) return {};
    const double scale = 0.18 / std::exp(sum / weight);
    // Lamps may burn out: white is at most 4 (22 keys), not the lamp's own luminance.
    const double white = std::clamp(scale * brightest, 1.0, 4.0);
    return {scale, white * white};
}

Vec3f PreviewTone::operator()(const Vec3f& value) const {
    const double L = scale * luminance(value);
    const double factor = scale * (1 + L / white_squared) / (1 + L);
    const auto shown = [&](float v) {
        return static_cast<float>(std::clamp(factor * double(v), 0.0, 1.0));
    };
    return {shown(value.x), shown(value.y), shown(value.z)};
}

}  // namespace exitance
