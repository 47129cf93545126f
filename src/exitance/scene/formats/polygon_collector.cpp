// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/polygon_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/math/triangulate.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Normals of a smooth surface stay within this of its facets; those averaged over the corners of a
// box stand at 54.7° from its faces.
constexpr double smooth_cosine = 0.70710678118654752;  // 45°
// Corners of a face may stand this share of its size out of its plane before it is told.
constexpr double planar_share = 1e-3;

std::vector<Vec3> points_of(std::span<const Corner> corners) {
    std::vector<Vec3> out;
    out.reserve(corners.size());
    for (const Corner& corner : corners) out.push_back(corner.point);
    return out;
}

std::vector<Corner> placed(std::span<const Corner> corners, const Transform& placing) {
    std::vector<Corner> out;
    out.reserve(corners.size());
    for (const Corner& corner : corners)
        out.push_back({placing.point(corner.point), normalized(placing.normal(corner.normal))});
    if (placing.determinant() < 0) std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace

std::size_t PolygonCollector::PointHash::operator()(const std::array<double, 6>& key) const {
    std::uint64_t hash = 0;
    for (const double value : key) hash = hash_bits(hash, std::bit_cast<std::uint64_t>(value));
    return hash;
}

std::uint32_t PolygonCollector::point_of(const Vec3& point, const Vec3& normal) {
    const Vec3 p = point + Vec3{}, n = normal + Vec3{};  // −0 becomes 0
    const auto [entry, fresh] = points_.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z}, 0U);
    if (fresh) entry->second = scene_.add_point(p, n);
    return entry->second;
}

std::uint32_t PolygonCollector::surface_of(const std::string& name, std::uint32_t material,
                                           const Place& place) {
    const auto [entry, fresh] = surfaces_.try_emplace({name, material}, 0U);
    if (fresh) {
        entry->second = scene_.add_surface(name, material);
        scene_.surfaces[entry->second].place = place;
    }
    return entry->second;
}

void PolygonCollector::start_surface(const std::string& name, std::uint32_t material,
                                     const Place& place) {
    name_ = name;
    material_ = material;
    surface_place_ = place;
    surface_ = surface_of(name, material, place);
}

void PolygonCollector::use_surface(std::uint32_t surface) {
    surface_ = surface;
    name_ = scene_.surfaces[surface].name;
    material_ = scene_.surfaces[surface].material;
    surface_place_ = scene_.surfaces[surface].place;
}

void PolygonCollector::add_polygon(std::span<const Corner> corners, std::uint32_t surface,
                                   const Place& place) {
    Polygon polygon;
    for (std::size_t i = 0; i < corners.size(); ++i)
        polygon.corners[i] = point_of(corners[i].point, corners[i].normal);
    polygon.surface = surface;
    // Lines count for the file that the surface is in.
    if (place.file == surface_place_.file) polygon.line = static_cast<std::uint32_t>(place.line);
    scene_.polygons.push_back(polygon);
}

void PolygonCollector::add_outline(std::vector<Corner> corners, const Place& place) {
    const std::vector<Vec3> points = points_of(corners);
    const Vec3 normal = unit_normal(points);
    for (Corner& corner : corners) {
        if (corner.normal == Vec3{}) continue;
        const double along = dot(corner.normal, normal);
        if (along < 0) corner.normal = -corner.normal;
        if (std::abs(along) >= smooth_cosine) continue;
        corner.normal = {};
        if (normal != Vec3{} && !warnings_.seen("normals"))
            warnings_.add("normals", place,
                          "a vertex normal more than 45° from its face is left out, as if averaged "
                          "over a box's corner");
    }
    if (corners.size() == 3 || (corners.size() == 4 && is_strictly_convex(points))) {
        budget_.spend_polygons(1, [&] { return place; });
        add_polygon(corners, surface_, place);
        return;
    }
    Box box;
    for (const Vec3& p : points) box.add(p);
    if (planarity_error(points) > planar_share * box.diagonal() && !warnings_.seen("bent"))
        warnings_.add("bent", place,
                      fmt::format("the {} corners of a face are not in one plane; it is made of "
                                  "triangles as seen along its mean normal",
                                  corners.size()));
    const Triangulation cut = triangulate(points);
    if (!cut.simple && !warnings_.seen("crossed"))
        warnings_.add("crossed", place,
                      fmt::format("the outline of a face of {} corners crosses itself; it is "
                                  "covered as well as can be",
                                  corners.size()));
    if (cut.triangles.empty() && !warnings_.seen("no area"))
        warnings_.add("no area", place, "a face has no area and is left out");
    budget_.spend_polygons(cut.triangles.size(), [&] { return place; });
    for (const auto& triangle : cut.triangles) {
        std::array<Corner, 3> three;
        for (std::size_t i = 0; i < 3; ++i) three[i] = corners[triangle[i]];
        add_polygon(three, surface_, place);
    }
}

void PolygonCollector::add_face(std::span<const Corner> corners, const Transform& placing,
                                const Place& place) {
    if (corners.size() > options_.max_corners)
        throw Error(place, fmt::format("found a face of {} corners, expected at most {}; "
                                       "--max-corners raises the limit",
                                       corners.size(), options_.max_corners));
    add_outline(placed(corners, placing), place);
}

void PolygonCollector::add_face_with_holes(const std::vector<std::vector<Corner>>& loops,
                                           const Transform& placing, const Place& place) {
    std::vector<std::vector<Vec3>> points;
    std::vector<Corner> all;
    for (const auto& loop : loops) {
        points.push_back(points_of(loop));
        all.insert(all.end(), loop.begin(), loop.end());
    }
    // Seams are searched for in time corners × holes × corners.
    if (all.size() * loops.size() > options_.max_corners)
        throw Error(place, fmt::format("found a face of {} corners with {} holes, expected a "
                                       "product of at most {}; --max-corners raises the limit",
                                       all.size(), loops.size() - 1, options_.max_corners));
    std::vector<Corner> outline;
    for (const std::uint32_t i : join_holes(points)) outline.push_back(all[i]);
    add_face(outline, placing, place);
}

void PolygonCollector::add_facets(const Facets& facets, const Transform& placing,
                                  const Place& place) {
    std::uint32_t surface = surface_;
    if (scene_.materials[material_].emits()) {
        // Four digits tell shapes apart, and rounding errors not.
        const double area = facets.area();
        const int factor =
            area > 0 ? static_cast<int>(std::lround(1e4 * facets.true_area / area)) : 10000;
        const auto [entry, fresh] = brighter_.try_emplace({material_, factor}, material_);
        if (fresh && factor != 10000) {
            Material brighter = scene_.materials[material_];
            for (double& band : brighter.exitance) band *= factor / 1e4;
            entry->second = scene_.add_material(std::move(brighter));
        }
        surface = surface_of(name_, entry->second, surface_place_);
    }
    const bool mirrored = placing.determinant() < 0;
    for (const auto& polygon : facets.polygons) {
        const std::size_t n = polygon[3] == Polygon::none ? 3 : 4;
        std::array<Corner, 4> corners;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t at = polygon[mirrored ? n - 1 - i : i];
            corners[i] = {placing.point(facets.points[at]),
                          normalized(placing.normal(facets.normals[at]))};
        }
        add_polygon({corners.data(), n}, surface, place);
    }
}

}  // namespace exitance
