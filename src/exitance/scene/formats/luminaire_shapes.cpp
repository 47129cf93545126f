// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/luminaire_shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "exitance/math/frame.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t disc_sectors = 24;
constexpr std::uint32_t sphere_meridians = 16, sphere_bands = 8;

double add_polygon(Scene& scene, std::uint32_t surface, std::array<std::uint32_t, 4> corners) {
    Polygon polygon;
    polygon.corners = corners;
    polygon.surface = surface;
    polygon.line = static_cast<std::uint32_t>(scene.surfaces[surface].place.line);
    scene.polygons.push_back(polygon);
    return scene.area(polygon);
}

}  // namespace

double add_rectangle(Scene& scene, std::uint32_t surface, const Vec3& centre, const Vec3& aim,
                     const Vec3& up, double width, double height) {
    const Vec3 vertical = normalized(up - aim * dot(up, aim));
    const Vec3 horizontal = cross(vertical, aim);
    const Vec3 u = horizontal * (width / 2), v = vertical * (height / 2);
    return add_polygon(scene, surface,
                       {scene.add_point(centre - u - v), scene.add_point(centre + u - v),
                        scene.add_point(centre + u + v), scene.add_point(centre - u + v)});
}

double add_disc(Scene& scene, std::uint32_t surface, const Vec3& centre, const Vec3& aim,
                double radius) {
    // A regular n-gon of circumradius R has the area n/2 R² sin(2π/n) = π r².
    const double step = 2 * pi / disc_sectors;
    const double rim = radius * std::sqrt(step / std::sin(step));
    const Frame frame(aim);
    const std::uint32_t middle = scene.add_point(centre);
    std::array<std::array<std::uint32_t, disc_sectors>, 2> rings;
    for (std::uint32_t ring = 0; ring < 2; ++ring)
        for (std::uint32_t s = 0; s < disc_sectors; ++s)
            rings[ring][s] = scene.add_point(
                centre + frame.to_world(Vec3{std::cos(s * step), std::sin(s * step), 0} *
                                        (rim * (ring + 1) / 2)));
    double area = 0;
    for (std::uint32_t s = 0; s < disc_sectors; ++s) {
        const std::uint32_t next = (s + 1) % disc_sectors;
        area += add_polygon(scene, surface, {middle, rings[0][s], rings[0][next], Polygon::none});
        area +=
            add_polygon(scene, surface, {rings[0][s], rings[1][s], rings[1][next], rings[0][next]});
    }
    return area;
}

double add_sphere(Scene& scene, std::uint32_t surface, const Vec3& centre, double radius) {
    std::vector<Vec3> unit;  // north pole, then bands of meridians, then south pole
    unit.push_back({0, 0, 1});
    for (std::uint32_t band = 1; band < sphere_bands; ++band)
        for (std::uint32_t m = 0; m < sphere_meridians; ++m) {
            const double theta = pi * band / sphere_bands, phi = 2 * pi * m / sphere_meridians;
            unit.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                            std::cos(theta)});
        }
    unit.push_back({0, 0, -1});
    const auto last = static_cast<std::uint32_t>(unit.size() - 1);
    const auto on_band = [](std::uint32_t band, std::uint32_t m) {
        return 1 + (band - 1) * sphere_meridians + m % sphere_meridians;
    };
    std::vector<std::array<std::uint32_t, 4>> faces;
    for (std::uint32_t m = 0; m < sphere_meridians; ++m) {
        faces.push_back({0, on_band(1, m), on_band(1, m + 1), Polygon::none});
        for (std::uint32_t band = 1; band + 1 < sphere_bands; ++band)
            faces.push_back({on_band(band, m), on_band(band + 1, m), on_band(band + 1, m + 1),
                             on_band(band, m + 1)});
        faces.push_back(
            {last, on_band(sphere_bands - 1, m + 1), on_band(sphere_bands - 1, m), Polygon::none});
    }
    // Inscribed, its area falls short of the sphere's; grown until they agree.
    Scene inscribed;
    inscribed.points = unit;
    inscribed.surfaces.resize(1);
    double area = 0;
    for (const auto& face : faces) area += add_polygon(inscribed, 0, face);
    const double grown = radius * std::sqrt(4 * pi / area);

    const auto first = static_cast<std::uint32_t>(scene.points.size());
    for (const Vec3& direction : unit) scene.add_point(centre + direction * grown);
    area = 0;
    for (auto face : faces) {
        for (std::uint32_t& corner : face)
            if (corner != Polygon::none) corner += first;
        area += add_polygon(scene, surface, face);
    }
    return area;
}

}  // namespace exitance
