// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "exitance/math/polygon.h"
#include "exitance/run/error.h"
#include "exitance/run/parallel.h"
#include "exitance/solution/extract.h"
#include "exitance/solution/file_layout.h"
#include "exitance/visibility/ray_caster.h"

namespace exitance {

namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error(Fault::bad_input, "--resume: the solution is of another scene: " + what);
}

void require_equal(std::size_t kept, std::size_t now, const char* things) {
    if (kept != now) refuse(fmt::format("found {} {}, expected {}", kept, things, now));
}

void require_same_materials(const Solution& kept, const Scene& scene) {
    require_equal(kept.materials.size(), scene.materials.size(), "materials");
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material &then = kept.materials[m], &now = scene.materials[m];
        if (then.name != now.name)
            refuse(fmt::format("found a material '{}', expected '{}'", then.name, now.name));
        const auto compare = [&](const Spectrum& a, const Spectrum& b, const char* what) {
            for (std::size_t i = 0; i < b.size(); ++i)
                if (a[i] != b[i])
                    refuse(fmt::format("material '{}' {} {:.4g}, expected {:.4g}", now.name, what,
                                       fmt::join(a, " "), fmt::join(b, " ")));
        };
        compare(then.reflectance, now.reflectance, "reflects");
        compare(then.exitance, now.exitance, "emits");
    }
}

std::vector<std::string> names_of(const std::vector<LightGroup>& groups) {
    std::vector<std::string> out;
    for (const LightGroup& group : groups) out.push_back("'" + group.name + "'");
    return out;
}

/// What was an element when a solution was made into triangles.
struct Cell {
    Vec3 place, normal;
    double area = 0;             ///< of one triangle, or of all of a fan
    std::uint32_t triangle = 0;  ///< its first
    std::uint32_t count = 1;
};

// Fans are triangles round one vertex, one after the other, that meet again (extract.cpp).
std::vector<Cell> cells_of(const Solution& solution) {
    std::vector<Cell> out;
    const auto& triangles = solution.triangles;
    for (const SolutionPart& part : solution.parts) {
        const std::uint32_t end = part.first_triangle + part.triangles;
        for (std::uint32_t t = part.first_triangle; t < end;) {
            std::uint32_t last = t;
            while (last + 1 < end && triangles[last + 1][0] == triangles[t][0] &&
                   triangles[last + 1][1] == triangles[last][2] &&
                   triangles[last][2] != triangles[t][1])
                ++last;
            const bool fan = last > t + 1 && triangles[last][2] == triangles[t][1];
            Cell cell;
            cell.triangle = t, cell.count = fan ? last - t + 1 : 1;
            Vec3 across;
            for (std::uint32_t k = t; k < t + cell.count; ++k) {
                const auto& [a, b, c] = triangles[k];
                const Vec3 p(solution.positions[a]);
                const Vec3 twice =
                    cross(Vec3(solution.positions[b]) - p, Vec3(solution.positions[c]) - p);
                across += twice, cell.area += 0.5 * length(twice);
                cell.place =
                    fan ? p : (p + Vec3(solution.positions[b]) + Vec3(solution.positions[c])) / 3.0;
            }
            t += cell.count;
            if (!(cell.area > 0)) continue;
            cell.normal = normalized(across);
            out.push_back(cell);
        }
    }
    return out;
}

RayCaster caster_over_patches(const Mesh& mesh) {
    std::vector<Vec3> points;
    std::vector<RayCaster::Face> faces;
    for (const Patch& patch : mesh.patches()) {
        const Element& root = mesh[patch.root];
        const auto first = static_cast<std::uint32_t>(points.size());
        const auto corners = mesh.corners(root);
        points.insert(points.end(), corners.begin(), corners.begin() + root.count);
        faces.push_back({first, first + 1, first + 2, first + root.count - 1});
    }
    return RayCaster(points, faces);
}

// How far inside the outline a point lies; < 0: outside.
double depth_in(const Mesh& mesh, const Element& element, const Vec3& normal, const Vec3& point) {
    const auto corners = mesh.corners(element);
    double out = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < element.count; ++i) {
        const Vec3 side = corners[(i + 1) % element.count] - corners[i];
        const double along = length(side);
        if (along > 0) out = std::min(out, dot(cross(normal, side), point - corners[i]) / along);
    }
    return out;
}

// The patch that a cell lies on: nearest to its plane, and containing its place.
PatchId patch_of(const Cell& cell, const Mesh& mesh, const RayCaster& caster, double reach) {
    PatchId best;
    double best_score = reach;
    caster.visit_near(cell.place, reach, [&](std::uint32_t i, double radius) {
        const PatchId id(i);
        const Face& face = mesh[mesh[id].face];
        if (!(dot(face.normal, cell.normal) > 0.5)) return radius;
        const Element& root = mesh[mesh[id].root];
        const double outside = std::max(0.0, -depth_in(mesh, root, face.normal, cell.place));
        const double off = std::abs(dot(face.normal, cell.place - mesh.corners(root)[0]));
        const double score = outside + off;
        if (score < best_score || (score == best_score && best.valid() && id < best))
            best = id, best_score = score;
        return radius;
    });
    return best;
}

void divide(Mesh& mesh, PatchId patch, const Cell& cell) {
    // Halfway, as areas go, between this size and the next.
    constexpr double allowed = 2;
    const Vec3& normal = mesh[mesh[patch].face].normal;
    const double area = cell.area * (cell.count == 1 && mesh[mesh[patch].root].count == 4 ? 2 : 1);
    ElementId id = mesh[patch].root;
    while (double(mesh[id].area) > allowed * area) {
        if (mesh[id].leaf()) mesh.split(id);
        if (mesh[id].leaf()) return;  // as small as elements get
        ElementId inside;
        double deepest = -std::numeric_limits<double>::infinity();
        for (std::uint32_t c = 0; c < 4; ++c) {
            const ElementId child(mesh[id].first_child.index() + c);
            const double depth = depth_in(mesh, mesh[child], normal, cell.place);
            if (depth > deepest) inside = child, deepest = depth;
        }
        id = inside;
    }
}

}  // namespace

void require_same_light(const Solution& kept, const Scene& scene,
                        const std::vector<LightGroup>& groups) {
    if (kept.bands != scene.bands)
        refuse(fmt::format("found the bands {}, expected {}", fmt::join(kept.bands, " "),
                           fmt::join(scene.bands, " ")));
    if (kept.quantity != scene.quantity)
        refuse(fmt::format("found {} values, expected {}",
                           solution_file::quantity_name(kept.quantity),
                           solution_file::quantity_name(scene.quantity)));
    if (kept.scene_digest != digest(scene)) {
        require_same_materials(kept, scene);
        require_equal(kept.luminaires.size(), scene.luminaires.size(), "luminaires");
        require_equal(kept.distant.size(), scene.distant.size(), "lights of sun and sky");
        refuse("its geometry, patterns or lamps differ");
    }
    const auto then = names_of(kept.groups), now = names_of(groups);
    if (then == now) return;
    const auto option = kept.options.find("groups");
    throw Error(
        Fault::bad_input,
        fmt::format(
            "--resume: the solution has the light groups {}, and this solve {}{}",
            fmt::join(then, ", "), fmt::join(now, ", "),
            option == kept.options.end() ? "" : "; it was solved with --groups " + option->second));
}

void describe_anew(Solution& kept, const Radiosity& radiosity) {
    const Scene& scene = radiosity.scene;
    kept.title = scene.title;
    kept.groups = radiosity.groups.groups;
    kept.light_scenes = scene.light_scenes;
    kept.cameras = scene.cameras;
    kept.grids = scene.grids;
}

std::vector<PatchId> take_over_mesh(Radiosity& radiosity, const Solution& kept,
                                    std::size_t most_vertices) {
    Mesh& mesh = radiosity.mesh;
    const std::vector<Cell> cells = cells_of(kept);
    const RayCaster caster = caster_over_patches(mesh);
    double farthest = 0;
    for (const Vec3f& p : kept.positions) farthest = std::max(farthest, length(Vec3(p)));
    // Places come from a file in float, and those of a fan may be off a patch that is bent a
    // little.
    const double reach = 16 * caster.clearance() + 0x1.0p-20 * farthest;
    std::vector<PatchId> patches(cells.size()), out(kept.triangles.size());
    parallel_for(cells.size(),
                 [&](std::size_t i) { patches[i] = patch_of(cells[i], mesh, caster, reach); });
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::fill_n(out.begin() + cells[i].triangle, cells[i].count, patches[i]);
        if (patches[i].valid() && mesh.vertices().size() < most_vertices)
            divide(mesh, patches[i], cells[i]);
    }
    radiosity.admit_new_vertices();
    return out;
}

}  // namespace exitance
