// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "exitance/math/box_tree.h"
#include "exitance/math/polygon.h"
#include "exitance/scene/coplanar.h"
#include "exitance/scene/mend.h"
#include "exitance/scene/sky.h"

namespace exitance {

namespace {

constexpr std::size_t most_of_a_kind = 20;  // surfaces or pairs of them that are named one by one
constexpr double on_surface = 1e-3;         // of a luminaire's middle [m]
constexpr double on_plane = 1e-6;           // on which side of it cannot be told [m]
constexpr double far_away = 10;  // from the scene, in its diagonals: millimetres taken for metres

Place place_of(const Scene& scene, const Polygon& polygon) {
    const Surface& surface = scene.surfaces[polygon.surface];
    if (polygon.line > 0) return {surface.place.file, polygon.line, 0};
    return surface.place;
}

void tell(std::vector<Problem>& problems, const Place& place, std::string what) {
    Problem& problem = problems.emplace_back();
    problem.place = place;
    problem.what = std::move(what);
}

std::string how_many(std::size_t count, const char* one, const char* several) {
    return count == 1 ? std::string("a ") + one : fmt::format("{} {}", count, several);
}

void check_materials(const Scene& scene, std::vector<Problem>& problems) {
    for (const Material& material : scene.materials) {
        for (const double rho : material.reflectance)
            if (!(rho >= 0 && rho < 1)) {
                tell(problems, material.place,
                     fmt::format("'{}' has the reflectance {:g}: light needs one below "
                                 "1 to die out",
                                 material.name, rho));
                break;
            }
        for (const double e : material.exitance)
            if (!(e >= 0)) {
                tell(problems, material.place,
                     fmt::format("'{}' has the exitance {:g}, which is "
                                 "not 0 or more",
                                 material.name, e));
                break;
            }
    }
}

// Polygons of one surface with one trouble.
class BySurface {
  public:
    void add(const Scene& scene, const Polygon& polygon) {
        auto& [count, place] = found_[polygon.surface];
        if (count++ == 0) place = place_of(scene, polygon);
    }
    void report(const Scene& scene, const char* one, const char* several,
                std::vector<Problem>& problems) const {
        std::size_t told = 0;
        for (const auto& [surface, entry] : found_) {
            if (told++ == most_of_a_kind) {
                tell(problems, {},
                     fmt::format("… and polygons of {} more surfaces {}",
                                 found_.size() - most_of_a_kind, several));
                return;
            }
            tell(problems, entry.second,
                 fmt::format("{} of {} {}", how_many(entry.first, "polygon", "polygons"),
                             scene.label(surface), entry.first == 1 ? one : several));
        }
    }

  private:
    std::map<std::uint32_t, std::pair<std::size_t, Place>> found_;
};

// True if all coordinates are numbers.
bool check_polygons(const Scene& scene, std::vector<Problem>& problems) {
    const double extent = scene.bounds().diagonal();
    BySurface wild, empty, bent;
    bool finite = true;
    for (const Polygon& polygon : scene.polygons) {
        const auto corners = scene.corners(polygon);
        const std::span<const Vec3> c(corners.data(), polygon.size());
        if (!std::all_of(c.begin(), c.end(), [](const Vec3& p) { return is_finite(p); })) {
            wild.add(scene, polygon);
            finite = false;
            continue;
        }
        Box box;
        for (const Vec3& p : c) box.add(p);
        if (!(area(c) > 0))
            empty.add(scene, polygon);
        else if (planarity_error(c) > planarity_tolerance(box.diagonal(), extent))
            bent.add(scene, polygon);
    }
    wild.report(scene, "has coordinates that are no numbers",
                "have coordinates that are no numbers", problems);
    empty.report(scene, "has no area", "have no area", problems);
    bent.report(scene, "is not planar", "are not planar", problems);
    return finite;
}

void report_pairs(const Scene& scene, const std::vector<FacePair>& pairs, const char* what,
                  std::vector<Problem>& problems) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, Place>> by_surfaces;
    for (const FacePair& pair : pairs) {
        const Polygon &a = scene.polygons[pair.first], &b = scene.polygons[pair.second];
        auto& [count, place] = by_surfaces[std::minmax(a.surface, b.surface)];
        if (count++ == 0) place = place_of(scene, b);
    }
    std::size_t told = 0;
    for (const auto& [surfaces, entry] : by_surfaces) {
        if (told++ == most_of_a_kind) {
            tell(problems, {},
                 fmt::format("… and so for {} more pairs of surfaces",
                             by_surfaces.size() - most_of_a_kind));
            return;
        }
        const std::string a = scene.label(surfaces.first), b = scene.label(surfaces.second);
        const bool first = scene.materials[scene.surfaces[surfaces.first].material].emits();
        const bool second = scene.materials[scene.surfaces[surfaces.second].material].emits();
        const std::string lamp =
            first == second ? ""
                            : fmt::format("; {}, which emits, is what counts there", first ? a : b);
        const std::string times = how_many(entry.first, "pair of faces", "pairs of faces");
        tell(problems, entry.second,
             surfaces.first == surfaces.second
                 ? fmt::format("{} of {} {}", times, a, what)
                 : fmt::format("{} of {} and {} {}{}", times, a, b, what, lamp));
    }
}

void check_luminaires(const Scene& scene, std::vector<Problem>& problems) {
    const Box bounds = scene.bounds();
    std::size_t told = 0, outside = 0;
    for (const Luminaire& luminaire : scene.luminaires) {
        const Vec3& p = luminaire.position;
        const Vec3 inside = max(bounds.lower, min(bounds.upper, p));
        if (length(p - inside) <= far_away * bounds.diagonal()) continue;
        ++outside;
        if (told++ < most_of_a_kind)
            tell(problems, luminaire.place,
                 fmt::format("the luminaire '{}' is far outside of the scene", luminaire.name));
    }
    if (outside > most_of_a_kind)
        tell(problems, {}, fmt::format("… and so are {} more", outside - most_of_a_kind));
}

// Distance of `p` from the convex polygon `c`.
double distance_to(const Vec3& p, std::span<const Vec3> c) {
    double nearest = std::numeric_limits<double>::infinity();
    const Vec3 normal = vector_area(c);
    bool inside = true;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const Vec3 a = c[i], along = c[(i + 1) % c.size()] - a;
        inside = inside && dot(cross(along, p - a), normal) >= 0;
        const double s = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
        nearest = std::min(nearest, length(p - a - along * s));
    }
    return inside ? std::abs(dot(p - c[0], normalized(normal))) : nearest;
}

// The share of a luminaire's light that goes to the side of `normal`, by the middles of 2 × 16 × 16
// cells of equal solid angle.
double share_towards(const Luminaire& luminaire, const Vec3& normal) {
    constexpr int n = 16;
    double all = 0, there = 0;
    for (int i = 0; i < 2 * n * n; ++i) {
        const Vec3 d = direction_of({i >= n * n, (i % n + 0.5) / n, (i / n % n + 0.5) / n});
        const double I = luminaire.intensity(d);
        all += I;
        if (dot(d, normal) > 0) there += I;
    }
    return all > 0 ? there / all : 0;
}

// Does a luminaire that all but touches the polygon `c` send light through it? One that is mounted
// on a ceiling sends none.
bool shines_through(const Luminaire& luminaire, std::span<const Vec3> c) {
    const Vec3 normal = unit_normal(c);
    const double before = dot(luminaire.position - c[0], normal);
    const double in_front = share_towards(luminaire, normal);
    const double through = std::abs(before) < on_plane ? std::min(in_front, 1 - in_front)
                           : before > 0                ? 1 - in_front
                                                       : in_front;
    return through > 0.01;
}

// Lamps without polygons whose light a surface cuts off where they stand.
void check_lamps_on_surfaces(const Scene& scene, std::vector<Problem>& problems) {
    if (scene.luminaires.empty()) return;
    std::vector<Box> boxes(scene.polygons.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < scene.polygons[i].size(); ++k)
            boxes[i].add(scene.corners(scene.polygons[i])[k]);
    const BoxTree tree(boxes);
    std::size_t found = 0;
    for (const Luminaire& luminaire : scene.luminaires) {
        const Vec3 reach{on_surface, on_surface, on_surface};
        Box near;
        near.add(luminaire.position - reach);
        near.add(luminaire.position + reach);
        const Polygon* on = nullptr;
        tree.for_overlapping(near, [&](std::uint32_t i) {
            const Polygon& polygon = scene.polygons[i];
            const auto corners = scene.corners(polygon);
            const std::span<const Vec3> c(corners.data(), polygon.size());
            if (!on && area(c) > 0 && distance_to(luminaire.position, c) < on_surface &&
                shines_through(luminaire, c))
                on = &polygon;
        });
        if (on && ++found <= most_of_a_kind)
            tell(problems, luminaire.place,
                 fmt::format("the luminaire '{}' stands within 1 mm of {} and shines through it: "
                             "expected a centimetre in front of it at least",
                             luminaire.name, scene.label(on->surface)));
    }
    if (found > most_of_a_kind)
        tell(problems, {}, fmt::format("… and so do {} more", found - most_of_a_kind));
}

}  // namespace

std::vector<Problem> validate(const Scene& scene) {
    std::vector<Problem> problems;
    check_materials(scene, problems);
    const bool finite = check_polygons(scene, problems);
    if (scene.polygons.empty()) {
        tell(problems, {}, "there are no polygons");
        return problems;
    }
    const auto shines = [](const Luminaire& l) { return l.flux() > 0; };
    if (std::none_of(scene.polygons.begin(), scene.polygons.end(),
                     [&](const Polygon& p) { return scene.material(p).emits(); }) &&
        std::none_of(scene.luminaires.begin(), scene.luminaires.end(), shines) &&
        std::none_of(scene.distant.begin(), scene.distant.end(),
                     [](const DistantLight& l) { return l.shines(); }))
        tell(problems, {}, "nothing emits light: the scene stays dark");
    if (!finite) return problems;
    check_luminaires(scene, problems);
    check_lamps_on_surfaces(scene, problems);
    const FaceOverlaps overlaps = find_overlaps(scene);
    report_pairs(scene, overlaps.duplicates, "lie in the same place", problems);
    report_pairs(scene, overlaps.overlaps, "overlap in one plane, facing the same way", problems);
    if (!overlaps.complete)
        tell(problems, {}, "there are more faces in one plane than were looked at");
    return problems;
}

}  // namespace exitance
