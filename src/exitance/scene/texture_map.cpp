// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/texture_map.h"

namespace exitance {

namespace {

using Which = TexturePoint TextureCoordinates::*;

std::array<TexturePoint, 3> points_of(const Scene& scene, const Polygon& polygon, Which which) {
    std::array<TexturePoint, 3> out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = scene.texture_coordinates_of(polygon.corners[i]).*which;
    return out;
}

Spectrum mean_of(const Scene& scene, const Polygon& polygon, const Pattern& pattern,
                 const Spectrum& even, Which which) {
    if (!pattern) return even;
    const auto at = points_of(scene, polygon, which);
    const TextureMap map(scene.corners(polygon), at);
    const auto corners = scene.corners(polygon);
    std::array<TexturePoint, 4> outline;
    for (std::size_t i = 0; i < polygon.size(); ++i) outline[i] = i < 3 ? at[i] : map(corners[i]);
    const Vec3 mean = pattern.mean({outline.data(), polygon.size()});
    return {mean.x, mean.y, mean.z};
}

}  // namespace

TextureMap::TextureMap(const std::array<Vec3, 4>& corners, const std::array<TexturePoint, 3>& at)
    : origin_(corners[0]), u_(double(at[0].u)), v_(double(at[0].v)) {
    // The dual of the two edges within their plane.
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], n = cross(a, b);
    const double squared = dot(n, n);
    if (!(squared > 0)) return;
    const Vec3 of_a = cross(b, n) / squared, of_b = cross(n, a) / squared;
    along_u_ = of_a * (double(at[1].u) - u_) + of_b * (double(at[2].u) - u_);
    along_v_ = of_a * (double(at[1].v) - v_) + of_b * (double(at[2].v) - v_);
}

TexturePoint TextureMap::operator()(const Vec3& place) const {
    const Vec3 from = place - origin_;
    return {static_cast<float>(u_ + dot(along_u_, from)),
            static_cast<float>(v_ + dot(along_v_, from))};
}

TextureMap reflectance_map(const Scene& scene, const Polygon& polygon) {
    return {scene.corners(polygon), points_of(scene, polygon, &TextureCoordinates::reflectance)};
}

TextureMap exitance_map(const Scene& scene, const Polygon& polygon) {
    return {scene.corners(polygon), points_of(scene, polygon, &TextureCoordinates::exitance)};
}

Spectrum mean_exitance(const Scene& scene, const Polygon& polygon) {
    const Material& material = scene.material(polygon);
    return mean_of(scene, polygon, material.exitance_pattern, material.exitance,
                   &TextureCoordinates::exitance);
}

Spectrum mean_reflectance(const Scene& scene, const Polygon& polygon) {
    const Material& material = scene.material(polygon);
    return mean_of(scene, polygon, material.reflectance_pattern, material.reflectance,
                   &TextureCoordinates::reflectance);
}

}  // namespace exitance
