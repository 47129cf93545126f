// SPDX-License-Identifier: Apache-2.0
// What text formats of polygons and curved bodies have in common: corners become points of the
// scene, outlines become triangles and quads, names and materials become surfaces.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "exitance/math/transform.h"
#include "exitance/scene/formats/curved_primitives.h"
#include "exitance/scene/formats/read_budget.h"
#include "exitance/scene/formats/read_warnings.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

struct Corner {
    Vec3 point, normal;  ///< shading normal, zero = none
};

class PolygonCollector {
  public:
    /// Adds to `scene`.
    PolygonCollector(Scene& scene, const ReadOptions& options, ReadBudget& budget,
                     ReadWarnings& warnings)
        : scene_(scene), options_(options), budget_(budget), warnings_(warnings) {}

    /// What is added from now on belongs to the surface of this name and material.
    void start_surface(const std::string& name, std::uint32_t material, const Place& place);

    /// The same for a surface that the scene has already.
    void use_surface(std::uint32_t surface);

    /// A face of three corners or more, planar as far as its file is exact; `place` is where it
    /// was declared. Shading normals count for smoothness only, never for the side; those more
    /// than 45° from the face are left out.
    void add_face(std::span<const Corner> corners, const Transform& placing, const Place& place);
    /// loops[0] with holes.
    void add_face_with_holes(const std::vector<std::vector<Corner>>& loops,
                             const Transform& placing, const Place& place);
    /// Facets of a curved body; the budget for them has been spent, before they were made. Facets
    /// that emit do so a little more than their material, so that
    /// the flux is that of the true surface.
    void add_facets(const Facets& facets, const Transform& placing, const Place& place);

    std::uint32_t facets_per_turn() const { return exitance::facets_per_turn(options_.tolerance); }

  private:
    struct PointHash {
        std::size_t operator()(const std::array<double, 6>& key) const;
    };
    std::uint32_t point_of(const Vec3& point, const Vec3& normal);
    std::uint32_t surface_of(const std::string& name, std::uint32_t material, const Place& place);
    void add_polygon(std::span<const Corner> corners, std::uint32_t surface, const Place& place);
    void add_outline(std::vector<Corner> corners, const Place& place);

    Scene& scene_;
    const ReadOptions& options_;
    ReadBudget& budget_;
    ReadWarnings& warnings_;
    std::string name_;
    std::uint32_t material_ = 0, surface_ = 0;
    Place surface_place_;
    std::unordered_map<std::array<double, 6>, std::uint32_t, PointHash> points_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> surfaces_;
    std::map<std::pair<std::uint32_t, int>, std::uint32_t> brighter_;  // by material and factor
};

}  // namespace exitance
