// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/closed_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "exitance/math/disjoint_sets.h"
#include "exitance/math/polygon.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Corners closer than this share of the scene are the same.
constexpr double weld = 0x1.0p-24;
// Longer bodies, relative to the scene, are rooms.
constexpr double longest_body = 0.5;
// Polygons that are looked for in bodies; bodies beyond that stay as they are.
constexpr std::uint64_t most_looked_at = 200'000'000;

// Every point's place: points that lie together have the same one.
std::vector<std::uint32_t> places_of(const Scene& scene, const Box& bounds) {
    // Above zero also where all corners are one point.
    const double cell = std::max(weld * bounds.diagonal(), 1e-100);
    std::vector<std::uint32_t> out(scene.points.size());
    std::unordered_map<std::uint64_t, std::uint32_t> places;
    for (std::uint32_t i = 0; i < scene.points.size(); ++i) {
        const Vec3 p = (scene.points[i] - bounds.lower) / cell;
        // A part of a cell on: coordinates with few digits do not lie on borders.
        const auto number = [](double x) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x + 0.382)));
        };
        out[i] =
            places.try_emplace(hash_bits(number(p.x), number(p.y), number(p.z)), i).first->second;
    }
    return out;
}

// Polygons along an edge: how many run along it each way, and one of them.
struct Edge {
    std::uint32_t forward = 0, backward = 0, polygon = 0;
};

struct Body {
    bool closed = true;
    double volume = 0;  // negative: fronts are inside
    Box box;
};

class Bodies {
  public:
    explicit Bodies(const Scene& scene)
        : scene_(scene), bounds_(scene.bounds()), joined_(scene.polygons.size()) {
        const std::vector<std::uint32_t> place = places_of(scene, bounds_);
        std::unordered_map<std::uint64_t, Edge> edges;
        for (std::uint32_t p = 0; p < scene.polygons.size(); ++p) {
            for_edges(scene.polygons[p], place, [&](std::uint64_t key, bool forward) {
                const auto [entry, fresh] = edges.try_emplace(key, Edge{0, 0, p});
                if (!fresh) joined_.join(p, entry->second.polygon);
                ++(forward ? entry->second.forward : entry->second.backward);
            });
        }
        for (std::uint32_t p = 0; p < scene.polygons.size(); ++p) add(p);
        for (const auto& [key, edge] : edges)
            if (edge.forward != 1 || edge.backward != 1)
                bodies_[joined_.find(edge.polygon)].closed = false;
        find_what_holds_others();
    }

    bool hides_back_of(std::uint32_t polygon) {
        const Body& body = bodies_.at(joined_.find(polygon));
        return body.closed && body.volume > 0;
    }

  private:
    template <class Visit>
    static void for_edges(const Polygon& polygon, const std::vector<std::uint32_t>& place,
                          const Visit& visit) {
        const std::uint32_t n = polygon.size();
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = place[polygon.corners[i]];
            const std::uint32_t b = place[polygon.corners[(i + 1) % n]];
            if (a != b) visit((std::uint64_t{std::min(a, b)} << 32) | std::max(a, b), a < b);
        }
    }

    void add(std::uint32_t p) {
        const Polygon& polygon = scene_.polygons[p];
        Body& body = bodies_[joined_.find(p)];
        if (scene_.material(polygon).transmits()) body.closed = false;
        const auto c = scene_.corners(polygon);
        const std::span<const Vec3> corners(c.data(), polygon.size());
        for (const Vec3& corner : corners) body.box.add(corner);
        // Sum of the pyramids over its faces, with their apex in the scene's middle.
        body.volume += dot(vector_area(corners), corners[0] - bounds_.centre()) / 3;
    }

    // Bodies are few and boxes are small: a sweep along x finds polygons of others in them.
    void find_what_holds_others() {
        std::vector<std::uint32_t> order(scene_.polygons.size());
        std::iota(order.begin(), order.end(), 0U);
        const auto corner = [&](std::uint32_t p) {
            return scene_.points[scene_.polygons[p].corners[0]];
        };
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return corner(a).x < corner(b).x; });
        const double slack = weld * bounds_.diagonal();
        std::uint64_t looked_at = 0;
        for (auto& [root, body] : bodies_) {
            if (body.box.diagonal() > longest_body * bounds_.diagonal()) body.closed = false;
            if (!body.closed || !(body.volume > 0)) continue;
            auto at = std::lower_bound(order.begin(), order.end(), body.box.lower.x + slack,
                                       [&](std::uint32_t p, double x) { return corner(p).x < x; });
            for (; at != order.end() && corner(*at).x < body.box.upper.x - slack && body.closed;
                 ++at) {
                if (++looked_at > most_looked_at) body.closed = false;
                const Vec3 c = corner(*at);
                if (c.y > body.box.lower.y + slack && c.y < body.box.upper.y - slack &&
                    c.z > body.box.lower.z + slack && c.z < body.box.upper.z - slack &&
                    joined_.find(*at) != root)
                    body.closed = false;
            }
        }
    }

    const Scene& scene_;
    Box bounds_;
    DisjointSets joined_;
    std::map<std::uint32_t, Body> bodies_;  // by root
};

// Surfaces without polygons, and materials without surfaces, go; the others keep their order.
void drop_unused(Scene& scene) {
    const auto compact = [](auto& list, std::vector<std::uint32_t>& number) {
        std::uint32_t kept = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (number[i] == 0) continue;
            if (kept != i) list[kept] = std::move(list[i]);
            number[i] = kept++;
        }
        list.resize(kept);
    };
    std::vector<std::uint32_t> surfaces(scene.surfaces.size()), materials(scene.materials.size());
    for (const Polygon& polygon : scene.polygons) surfaces[polygon.surface] = 1;
    for (std::size_t s = 0; s < surfaces.size(); ++s)
        if (surfaces[s] != 0) materials[scene.surfaces[s].material] = 1;
    compact(scene.surfaces, surfaces);
    compact(scene.materials, materials);
    for (Polygon& polygon : scene.polygons) polygon.surface = surfaces[polygon.surface];
    for (Surface& surface : scene.surfaces) surface.material = materials[surface.material];
}

}  // namespace

void close_bodies(Scene& scene) {
    if (scene.polygons.empty()) return;
    Bodies bodies(scene);
    std::map<std::uint32_t, std::uint32_t> one_sided_material, one_sided_surface;
    std::map<std::uint32_t, std::uint32_t> emitted;  // polygons, by material
    for (std::uint32_t p = 0; p < scene.polygons.size(); ++p) {
        Polygon& polygon = scene.polygons[p];
        const std::uint32_t material = scene.surfaces[polygon.surface].material;
        if (!scene.materials[material].two_sided || !bodies.hides_back_of(p)) continue;
        if (scene.materials[material].emits()) ++emitted[material];
        const auto [surface, fresh_surface] = one_sided_surface.try_emplace(polygon.surface, 0U);
        if (fresh_surface) {
            const auto [entry, fresh] = one_sided_material.try_emplace(material, 0U);
            if (fresh) {
                Material copy = scene.materials[material];
                copy.two_sided = false;
                entry->second = scene.add_material(std::move(copy));
            }
            Surface copy = scene.surfaces[polygon.surface];
            copy.material = entry->second;
            scene.surfaces.push_back(std::move(copy));
            surface->second = static_cast<std::uint32_t>(scene.surfaces.size() - 1);
        }
        polygon.surface = surface->second;
    }
    for (const auto& [material, polygons] : emitted)
        scene.warnings.push_back(
            {scene.materials[material].place,
             fmt::format("material '{}' is two-sided and would emit into closed bodies ({} "
                         "polygons); there it emits outward only",
                         scene.materials[material].name, polygons)});
    drop_unused(scene);
}

}  // namespace exitance
