// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/overlays.h"

#include <algorithm>
#include <cmath>

#include "exitance/render/canvas.h"
#include "exitance/render/raycast.h"
#include "exitance/render/tone.h"

namespace exitance {

namespace {

double line_width(const Image& image) {
    return std::max(1.0, std::min(image.width, image.height) / 900.0);
}

}  // namespace

void draw_wireframe(Image& image, const Surfaces& surfaces, const CameraRays& camera,
                    std::uint32_t samples, std::uint64_t seed) {
    const double half = 0.5 * line_width(image);
    const Raycast lines = raycast(
        surfaces, camera, image.width, image.height, samples, seed, [&](const ViewHit& hit) {
            const auto [a, b, c] = surfaces.corners(hit.place.triangle);
            const double distance = std::min({camera.distance_to_line(hit.x, hit.y, a, b),
                                              camera.distance_to_line(hit.x, hit.y, b, c),
                                              camera.distance_to_line(hit.x, hit.y, c, a)});
            return Vec3f{distance < half ? 1.0f : 0.0f, 0, 0};
        });
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        // Bright lines; dark ones only on what is nearly white.
        Vec3f& pixel = image.pixels[i];
        const float shade = luminance(pixel) > 0.6 ? 0.0f : 0.7f;
        const Vec3f ink{shade, shade, shade};
        pixel = pixel + (ink - pixel) * (0.5f * lines.image.pixels[i].x);
    }
}

void draw_normals(Image& image, const Surfaces& surfaces, const CameraRays& camera) {
    const Solution& s = surfaces.solution();
    const double length = surfaces.diagonal() / 40, width = line_width(image);
    const double spacing = 9 * width;
    const auto columns = static_cast<std::size_t>(image.width / spacing) + 1;
    const auto rows = static_cast<std::size_t>(image.height / spacing) + 1;
    std::vector<char> taken(columns * rows, 0);
    Canvas canvas(image);
    for (std::size_t v = 0; v < s.positions.size(); ++v) {
        const Vec3 foot(s.positions[v]), normal(s.normals[v]);
        const auto seen = camera.project(foot), tip = camera.project(foot + normal * length);
        if (!seen || !tip || dot(normal, camera.eye() - foot) <= 0) continue;
        const auto [x, y] = *seen;
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        char& cell = taken[static_cast<std::size_t>(y / spacing) * columns +
                           static_cast<std::size_t>(x / spacing)];
        if (cell) continue;
        // The foot stands clear of its surface; what is in front of it must be farther than that.
        const Vec3 clear = foot + normal * (1e-4 * surfaces.diagonal());
        const Vec3 ray = clear - camera.eye();
        if (surfaces.caster().closest(camera.eye(), ray, 0, 1)) continue;
        cell = 1;
        canvas.line(x, y, (*tip)[0], (*tip)[1], width, {0.05f, 0.35f, 1.0f}, 0.9);
        canvas.fill(x - width, y - width, x + width, y + width, {1.0f, 0.75f, 0.1f});
    }
}

}  // namespace exitance
