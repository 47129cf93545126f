// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/scene_enclosure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/math/polygon.h"
#include "exitance/mesh/mesh.h"
#include "exitance/run/error.h"

namespace exitance {

namespace {

double emissivity_of(const Material& material) {
    double sum = 0;
    for (std::size_t band = 0; band < material.reflectance.size(); ++band)
        sum += material.reflectance[band];
    const auto bands = static_cast<double>(std::max<std::size_t>(1, material.reflectance.size()));
    return std::clamp(1 - sum / bands, 0.0, 1.0);
}

class EnclosureBuilder {
  public:
    EnclosureBuilder(const Scene& scene, const EnclosureOptions& options)
        : scene_(scene), by_(options.by), options_(options), rows_(scene.surfaces.size()) {
        if (by_.empty()) by_ = scene.form_factors.surfaces.empty() ? "polygon" : "surface";
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            rows_[s] = {static_cast<std::uint32_t>(s),
                        emissivity_of(scene.materials[scene.surfaces[s].material]), false};
        read_setup();
    }

    Enclosure build() {
        if (by_ == "surface")
            add_surfaces();
        else if (by_ == "polygon")
            add_polygons();
        else
            add_patches();
        for (std::size_t i = 0; i < made_.surfaces.size(); ++i)
            made_.surfaces[i].emissivity =
                made_.surfaces[i].area > 0 ? emitted_[i] / made_.surfaces[i].area : 1;
        if (made_.surfaces.empty())
            throw Error(Fault::bad_input,
                        "the scene has no polygons, expected some to exchange light");
        return std::move(made_);
    }

  private:
    struct SurfaceRow {
        std::uint32_t target;  // the surface that its results are added to
        double emissivity;
        bool only_blocks;
    };

    void read_setup() {
        const auto& asked = scene_.form_factors.surfaces;
        for (const FormFactorSurface& entry : asked) {
            SurfaceRow& row = rows_[entry.surface];
            row.emissivity = entry.emissivity;
            row.only_blocks = entry.role == FormFactorRole::obstruction;
            std::uint32_t steps = 0;
            const FormFactorSurface* last = &entry;
            while (last->combine) {
                last = &asked[*last->combine];
                if (++steps > asked.size())
                    throw Error(scene_.surfaces[entry.surface].place,
                                fmt::format("surface {} is combined with itself in a circle",
                                            scene_.label(entry.surface)));
            }
            row.target = last->surface;
        }
    }

    std::uint32_t new_row(std::string name) {
        made_.surfaces.push_back({std::move(name), 0, 1});
        emitted_.push_back(0);
        return static_cast<std::uint32_t>(made_.surfaces.size() - 1);
    }

    // One side of an outline of three or four corners, as convex planar facets of `row`.
    void add_side(std::span<const Vec3> corners, bool back, std::uint32_t row, double emissivity) {
        const bool whole =
            corners.size() == 3 || (is_strictly_convex(corners) &&
                                    planarity_error(corners) <= 1e-9 * longest_side(corners));
        const auto add = [&](std::vector<Vec3> outline) {
            if (back) std::reverse(outline.begin(), outline.end());
            Facet facet;
            facet.count = static_cast<std::uint32_t>(outline.size());
            std::copy(outline.begin(), outline.end(), facet.outline.begin());
            if (facet.count == 3) facet.outline[3] = facet.outline[2];
            facet.row = row;
            facet.area = area(outline);
            facet.normal = unit_normal(outline);
            if (!(facet.area > 0)) return;
            if (row != Facet::only_blocks) {
                made_.surfaces[row].area += facet.area;
                emitted_[row] += emissivity * facet.area;
            }
            made_.facets.push_back(facet);
        };
        if (whole) return add({corners.begin(), corners.end()});
        // Along the diagonal that keeps both triangles' normals with the outline's.
        const Vec3 n = vector_area(corners);
        const auto turns = [&](std::size_t a, std::size_t b, std::size_t c) {
            return dot(cross(corners[b] - corners[a], corners[c] - corners[a]), n) > 0;
        };
        if (turns(0, 1, 2) && turns(0, 2, 3)) {
            add({corners[0], corners[1], corners[2]});
            add({corners[0], corners[2], corners[3]});
        } else {
            add({corners[1], corners[2], corners[3]});
            add({corners[1], corners[3], corners[0]});
        }
    }

    const SurfaceRow& row_of(const Polygon& polygon) const { return rows_[polygon.surface]; }

    std::string target_name(const Polygon& polygon) const {
        return scene_.surfaces[row_of(polygon).target].name;
    }

    std::span<const Vec3> outline(const Polygon& polygon) {
        corners_ = scene_.corners(polygon);
        return {corners_.data(), polygon.size()};
    }

    void add_blocker(const Polygon& polygon) {
        add_side(outline(polygon), false, Facet::only_blocks, 0);
    }

    void add_surfaces() {
        std::map<std::uint32_t, std::uint32_t> row_of_surface;
        // Rows in the order of the surfaces, whichever polygon comes first.
        std::vector<char> used(rows_.size(), 0);
        for (const Polygon& polygon : scene_.polygons)
            if (!row_of(polygon).only_blocks) used[row_of(polygon).target] = 1;
        for (std::uint32_t s = 0; s < used.size(); ++s)
            if (used[s]) row_of_surface[s] = new_row(scene_.surfaces[s].name);
        for (const Polygon& polygon : scene_.polygons) {
            if (row_of(polygon).only_blocks) {
                add_blocker(polygon);
                continue;
            }
            const std::uint32_t row = row_of_surface.at(row_of(polygon).target);
            add_side(outline(polygon), false, row, row_of(polygon).emissivity);
            if (scene_.material(polygon).two_sided)
                add_side(outline(polygon), true, row, row_of(polygon).emissivity);
        }
    }

    // "wall", or "wall.2" where the surface has several.
    std::string part_name(const Polygon& polygon, bool back) {
        const std::uint32_t number = ++parts_made_[polygon.surface];
        std::string name = target_name(polygon);
        if (parts_of_[polygon.surface] > 1) name += fmt::format(".{}", number);
        return back ? name + ".back" : name;
    }

    void add_polygons() {
        for (const Polygon& polygon : scene_.polygons) ++parts_of_[polygon.surface];
        for (const Polygon& polygon : scene_.polygons) {
            if (row_of(polygon).only_blocks) {
                add_blocker(polygon);
                continue;
            }
            const std::string name = part_name(polygon, false);
            add_side(outline(polygon), false, new_row(name), row_of(polygon).emissivity);
            if (scene_.material(polygon).two_sided)
                add_side(outline(polygon), true, new_row(name + ".back"),
                         row_of(polygon).emissivity);
        }
    }

    double patch_size() const {
        if (options_.patch_size) return *options_.patch_size;
        return std::max(1e-9, 0.05 * std::sqrt(scene_.area()));
    }

    // A row takes half a kilobyte before there is any matrix.
    void refuse_too_many() const {
        constexpr double most = 1e6;
        double rows = scene_.area() / (patch_size() * patch_size());
        if (by_ == "element") rows *= std::pow(4.0, options_.levels);
        if (rows > most)
            throw Error(
                Fault::wrong_use,
                fmt::format("--by {}: about {:.2g} rows with patches of {:g} m, expected at "
                            "most {:g}; larger patches (--patch-size){}",
                            by_, rows, patch_size(), most,
                            by_ == "element" ? " or fewer --levels" : ""));
    }

    void add_patches() {
        refuse_too_many();
        Mesh mesh(scene_, MeshOptions::of_patches(patch_size()));
        if (by_ == "element") divide(mesh);
        for (const Patch& patch : mesh.patches()) {
            const Face& face = mesh[patch.face];
            const Polygon& polygon = scene_.polygons[face.polygon.index()];
            if (!row_of(polygon).only_blocks)
                mesh.for_leaves(patch.root, [&](ElementId) { ++parts_of_[polygon.surface]; });
        }
        for (const Patch& patch : mesh.patches()) {
            const Face& face = mesh[patch.face];
            const Polygon& polygon = scene_.polygons[face.polygon.index()];
            if (row_of(polygon).only_blocks) continue;
            mesh.for_leaves(patch.root, [&](ElementId id) {
                const auto corners = mesh.corners(mesh[id]);
                add_side(std::span(corners.data(), mesh[id].count), false,
                         new_row(part_name(polygon, face.back)), row_of(polygon).emissivity);
            });
        }
        for (const Polygon& polygon : scene_.polygons)
            if (row_of(polygon).only_blocks) add_blocker(polygon);
    }

    void divide(Mesh& mesh) const {
        for (int level = 0; level < options_.levels; ++level) {
            std::vector<ElementId> leaves;
            for (const Patch& patch : mesh.patches())
                mesh.for_leaves(patch.root, [&](ElementId id) { leaves.push_back(id); });
            for (const ElementId id : leaves)
                if (mesh[id].leaf() && mesh[id].level == level) mesh.split(id);
        }
    }

    const Scene& scene_;
    std::string by_;
    const EnclosureOptions& options_;
    std::vector<SurfaceRow> rows_;
    Enclosure made_;
    std::vector<double> emitted_;  // emissivity × area
    std::array<Vec3, 4> corners_{};
    std::map<std::uint32_t, std::uint32_t> parts_of_, parts_made_;
};

}  // namespace

Options describe(EnclosureOptions& o) {
    return {
        {"by",
         &o.by,
         "what a row of the matrix stands for; default: surface for .vs3, else polygon",
         "",
         0,
         0,
         {"polygon", "patch", "element", "surface"}},
        {"patch-size", &o.patch_size,
         "longest edge of a patch where the file does not divide; default: a twentieth of the root "
         "of the scene's area",
         "m", 1e-6},
        {"levels", &o.levels, "how often each patch is divided in four, for --by element", "", 0,
         6},
    };
}

Enclosure make_enclosure(const Scene& scene, const EnclosureOptions& options) {
    return EnclosureBuilder(scene, options).build();
}

}  // namespace exitance
