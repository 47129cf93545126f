// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/place_owners.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

constexpr double parallel_cosine = 0.9999;

struct Plane {
    std::array<Vec3, 4> corners;
    std::uint32_t count;
    Vec3 normal, centre;
    double radius;

    Plane(const Scene& scene, std::uint32_t polygon)
        : corners(scene.corners(scene.polygons[polygon])),
          count(scene.polygons[polygon].size()),
          normal(scene.normal(scene.polygons[polygon])),
          centre(centroid({corners.data(), count})),
          radius(radius_about(centre, {corners.data(), count})) {}
};

Cover cover_of(const Plane& plane, const Vec3& middle) {
    Cover cover;
    for (std::uint32_t i = 0; i < 4; ++i) {
        const Vec3& a = plane.corners[i % plane.count];
        const Vec3& b = plane.corners[(i + 1) % plane.count];
        cover.inward[i] = Vec3f(normalized(cross(plane.normal, b - a)));
        cover.offset[i] = static_cast<float>(dot(Vec3(cover.inward[i]), a - middle));
    }
    return cover;
}

// All corners of `plane` lie outside one edge of `other`, or touch it.
bool apart(const Plane& plane, const Plane& other, double margin) {
    for (std::uint32_t i = 0; i < other.count; ++i) {
        const Vec3& a = other.corners[i];
        const Vec3 inward =
            normalized(cross(other.normal, other.corners[(i + 1) % other.count] - a));
        double deepest = -INFINITY;
        for (std::uint32_t k = 0; k < plane.count; ++k)
            deepest = std::max(deepest, dot(plane.corners[k] - a, inward));
        if (deepest <= margin) return true;
    }
    return false;
}

bool emits(const Scene& scene, std::uint32_t polygon) {
    return scene.material(scene.polygons[polygon]).emits();
}

// A lamp that is drawn flush with a ceiling shines; of equals the first owns the place.
bool goes_before(const Scene& scene, std::uint32_t a, std::uint32_t b) {
    const bool lamp = emits(scene, a);
    return lamp == emits(scene, b) ? a < b : lamp;
}

}  // namespace

PlaceOwners::PlaceOwners(const Scene& scene, const RayCaster& caster) {
    // Both ends of a ray keep clear of their surfaces: what is nearer than that hides nothing.
    const double near = 2 * caster.clearance();
    const std::size_t sides = 2 * scene.polygons.size();
    std::vector<std::vector<std::uint32_t>> found(sides);
    parallel_for(
        scene.polygons.size(),
        [&](std::size_t p) {
            const auto polygon = static_cast<std::uint32_t>(p);
            const Plane plane(scene, polygon);
            if (plane.normal == Vec3{}) return;
            const auto look_at = [&](std::uint32_t other, double radius) {
                if (!goes_before(scene, other, polygon)) return radius;
                const Plane owner(scene, other);
                const double facing = dot(owner.normal, plane.normal);
                if (std::abs(facing) < parallel_cosine) return radius;
                for (std::uint32_t i = 0; i < plane.count; ++i)
                    if (std::abs(dot(plane.corners[i] - owner.corners[0], owner.normal)) > near)
                        return radius;
                if (apart(plane, owner, near) || apart(owner, plane, near)) return radius;
                const bool both = scene.material(scene.polygons[other]).two_sided;
                if (both || facing > 0) found[2 * p].push_back(other);
                if (both || facing < 0) found[2 * p + 1].push_back(other);
                return radius;
            };
            caster.visit_near(plane.centre, plane.radius, look_at);
        },
        64);
    begin_.push_back(0);
    lamps_.assign(sides, 0);
    for (std::size_t side = 0; side < sides; ++side) {
        auto& owners = found[side];
        std::sort(owners.begin(), owners.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return goes_before(scene, a, b); });
        for (const std::uint32_t owner : owners)
            covers_.push_back(cover_of(Plane(scene, owner), caster.middle()));
        if (!owners.empty() && !emits(scene, static_cast<std::uint32_t>(side / 2)))
            lamps_[side] = static_cast<std::uint32_t>(
                std::count_if(owners.begin(), owners.end(),
                              [&](std::uint32_t owner) { return emits(scene, owner); }));
        begin_.push_back(static_cast<std::uint32_t>(covers_.size()));
    }
}

std::span<const Cover> PlaceOwners::covers(PolygonId polygon, bool back) const {
    const std::size_t side = 2 * polygon.index() + (back ? 1 : 0);
    return std::span(covers_).subspan(begin_[side], begin_[side + 1] - begin_[side]);
}

bool PlaceOwners::owns(PolygonId polygon, bool back, const Vec3& place) const {
    for (const Cover& cover : covers(polygon, back))
        if (cover.contains(Vec3f(place))) return false;
    return true;
}

bool PlaceOwners::below_lamp(PolygonId polygon, bool back, const Vec3& place) const {
    const auto lamps = covers(polygon, back).first(lamps_[2 * polygon.index() + (back ? 1 : 0)]);
    return std::any_of(lamps.begin(), lamps.end(),
                       [&](const Cover& cover) { return cover.contains(Vec3f(place)); });
}

}  // namespace exitance
