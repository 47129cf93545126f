// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/distant_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

Spectrum DistantLight::radiance(const Vec3& along) const {
    Spectrum out(colour);
    if (map) {
        const auto rgb = map->radiance(along);
        for (std::size_t b = 0; b < out.size(); ++b) out[b] *= strength * rgb[b % 3];
        return out;
    }
    const double level = strength * (along.y > 0 ? model.luminance(along) : ground);
    for (double& band : out) band *= level;
    return out;
}

bool DistantLight::shines() const {
    if (kind == Kind::disc) return irradiance > 0;
    if (!(strength > 0)) return false;
    if (!map) return model.scale > 0 || ground > 0;
    for (const float value : map->cells)
        if (value > 0) return true;
    return false;
}

double horizontal_irradiance(const DistantLight& light) {
    if (light.kind == DistantLight::Kind::disc)
        return light.irradiance * std::max(0.0, light.direction.y);
    // ∫ L cosθ dω over cells of equal solid angle, those of the map or 128 × 128, by their middles.
    const int n = light.map ? std::max(128, static_cast<int>(light.map->side())) : 128;
    double sum = 0;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const Vec3 d = direction_of({false, (column + 0.5) / n, (row + 0.5) / n});
            sum += luminance(light.radiance(d)) * d.y;
        }
    return sum * 2 * std::numbers::pi / (n * n);
}

}  // namespace exitance
