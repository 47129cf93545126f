// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/mend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "exitance/math/polygon.h"
#include "exitance/scene/formats/limits.h"

namespace exitance {

namespace {

// What was done to the polygons of one surface, and where first.
struct Mended {
    std::size_t count = 0;
    std::uint32_t first_line = 0;
};
using PerSurface = std::map<std::uint32_t, Mended>;

void note(PerSurface& notes, const Polygon& polygon) {
    Mended& mended = notes[polygon.surface];
    if (mended.count++ == 0) mended.first_line = polygon.line;
}

void warn(Scene& scene, const PerSurface& notes, const char* one, const char* several) {
    for (const auto& [s, mended] : notes) {
        const Surface& surface = scene.surfaces[s];
        Problem problem;
        problem.place = surface.place;
        if (mended.first_line > 0) problem.place = {surface.place.file, mended.first_line, 0};
        problem.what =
            fmt::format("{} of {} {}",
                        mended.count == 1 ? "a polygon" : fmt::format("{} polygons", mended.count),
                        scene.label(s), mended.count == 1 ? one : several);
        scene.warnings.push_back(std::move(problem));
    }
}

void check_points(const Scene& scene) {
    for (const Polygon& polygon : scene.polygons)
        for (const std::uint32_t i : polygon.indices())
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (!(std::abs(scene.points[i][axis]) <= limits::coordinate)) {
                    const Surface& surface = scene.surfaces[polygon.surface];
                    throw Error(
                        {surface.place.file, polygon.line, 0},
                        fmt::format("found the coordinate {} in {}, expected at most {:g} m "
                                    "from the origin",
                                    scene.points[i][axis], scene.label(polygon.surface),
                                    limits::coordinate));
                }
}

void mend_material(Material& material, std::vector<Problem>& warnings) {
    for (const double rho : material.reflectance)
        if (!(rho >= 0 && rho <= 1))
            throw Error(material.place,
                        fmt::format("found the reflectance {} in '{}', expected 0 to 1", rho,
                                    material.name));
    for (const double e : material.exitance)
        if (!(e >= 0 && e <= limits::exitance))
            throw Error(material.place,
                        fmt::format("found the exitance {} in '{}', expected 0 to {:g}", e,
                                    material.name, limits::exitance));
    const double most = *std::max_element(material.reflectance.begin(), material.reflectance.end());
    if (most <= largest_reflectance) return;
    warnings.push_back(
        {material.place,
         fmt::format(
             "the reflectance {:g} of '{}' is limited to {}: above it, light hardly dies out", most,
             material.name, largest_reflectance)});
    for (double& rho : material.reflectance) rho = std::min(rho, largest_reflectance);
}

// Corners in order without neighbours at the same place; fewer than three left = no area.
std::vector<std::uint32_t> distinct_corners(const Scene& scene, const Polygon& polygon) {
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t i : polygon.indices())
        if (kept.empty() || !(scene.points[i] == scene.points[kept.back()])) kept.push_back(i);
    while (kept.size() > 1 && scene.points[kept.front()] == scene.points[kept.back()])
        kept.pop_back();
    return kept;
}

// Thinner than this share of its length, a polygon is the rounding of float coordinates.
bool has_area(double area, double diagonal) {
    return area > 1e-7 * diagonal * diagonal;
}

// Which diagonal splits a quad into two triangles that face the same way; 0-2 if both or none do.
bool split_at_second_corner(const std::array<Vec3, 4>& c) {
    const auto agree = [](const Vec3& a, const Vec3& b) { return dot(a, b) > 0; };
    const bool first = agree(cross(c[1] - c[0], c[2] - c[0]), cross(c[2] - c[0], c[3] - c[0]));
    const bool second = agree(cross(c[2] - c[1], c[3] - c[1]), cross(c[3] - c[1], c[0] - c[1]));
    return second && !first;
}

bool is_convex(std::span<const Vec3> c, const Vec3& normal) {
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 turn = cross(c[(i + 1) % 4] - c[i], c[(i + 2) % 4] - c[(i + 1) % 4]);
        if (dot(turn, normal) < 0) return false;
    }
    return true;
}

double diagonal_of(std::span<const Vec3> corners) {
    Box box;
    for (const Vec3& c : corners) box.add(c);
    return box.diagonal();
}

enum class Shape { sound, empty, bent, dented };

Shape shape_of(std::span<const Vec3> c, double scene_extent) {
    if (c.size() < 3) return Shape::empty;
    const double diagonal = diagonal_of(c);
    if (c.size() == 3) return has_area(area(c), diagonal) ? Shape::sound : Shape::empty;
    const double halves =
        length(cross(c[2] - c[0], c[1] - c[0])) + length(cross(c[2] - c[0], c[3] - c[0]));
    if (!has_area(halves, diagonal)) return Shape::empty;
    if (!has_area(area(c), diagonal) ||
        planarity_error(c) > planarity_tolerance(diagonal, scene_extent))
        return Shape::bent;
    return is_convex(c, vector_area(c)) ? Shape::sound : Shape::dented;
}

void mend_polygons(Scene& scene) {
    const double extent = scene.bounds().diagonal();
    PerSurface empty, bent, dented;
    std::vector<Polygon> mended;
    mended.reserve(scene.polygons.size());
    const auto add_triangle = [&](const Polygon& of, std::array<std::uint32_t, 3> corners) {
        Polygon triangle = of;
        triangle.corners = {corners[0], corners[1], corners[2], Polygon::none};
        triangle.patches = (of.patches + 1) / 2;
        const auto c = scene.corners(triangle);
        const std::span<const Vec3> three(c.data(), 3);
        if (has_area(area(three), diagonal_of(three))) mended.push_back(triangle);
    };
    for (const Polygon& polygon : scene.polygons) {
        const auto kept = distinct_corners(scene, polygon);
        Polygon now = polygon;
        for (std::size_t i = 0; i < 4; ++i)
            now.corners[i] = i < kept.size() ? kept[i] : Polygon::none;
        std::array<Vec3, 4> c;
        for (std::size_t i = 0; i < kept.size(); ++i) c[i] = scene.points[kept[i]];
        const Shape shape = shape_of({c.data(), kept.size()}, extent);
        if (shape == Shape::sound) mended.push_back(now);
        if (shape == Shape::empty) note(empty, polygon);
        if (shape == Shape::bent) note(bent, polygon);
        if (shape == Shape::dented) note(dented, polygon);
        if (shape == Shape::bent || shape == Shape::dented) {
            const std::uint32_t first = split_at_second_corner(c) ? 1 : 0;
            const auto corner = [&](std::uint32_t i) { return now.corners[(first + i) % 4]; };
            add_triangle(now, {corner(0), corner(1), corner(2)});
            add_triangle(now, {corner(0), corner(2), corner(3)});
        }
    }
    scene.polygons = std::move(mended);
    warn(scene, empty, "has no area and is left out", "have no area and are left out");
    warn(scene, bent, "is not planar and is split into two triangles",
         "are not planar and are split into two triangles each");
    warn(scene, dented, "is not convex and is split into two triangles",
         "are not convex and are split into two triangles each");
}

}  // namespace

double planarity_tolerance(double polygon_diagonal, double scene_diagonal) {
    return 1e-6 * polygon_diagonal + 0x1.0p-24 * scene_diagonal;
}

void mend(Scene& scene) {
    check_points(scene);
    for (Material& material : scene.materials) mend_material(material, scene.warnings);
    mend_polygons(scene);
}

}  // namespace exitance
