// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/surfaces.h"

#include "exitance/math/box.h"

namespace exitance {

namespace {

double diagonal_of(const Solution& solution) {
    Box box;
    for (const Vec3f& p : solution.positions) box.add(Vec3(p));
    return box.diagonal();
}

std::vector<std::uint32_t> parts_of_triangles(const Solution& solution) {
    std::vector<std::uint32_t> out(solution.triangles.size(), 0);
    for (std::uint32_t p = 0; p < solution.parts.size(); ++p)
        std::fill_n(out.begin() + solution.parts[p].first_triangle, solution.parts[p].triangles, p);
    return out;
}

RayCaster caster_of(const Solution& solution, const std::vector<std::uint32_t>& part_of_triangle,
                    Backs backs) {
    const std::vector<Vec3> points(solution.positions.begin(), solution.positions.end());
    std::vector<RayCaster::Face> faces;
    std::vector<char> open;
    std::vector<float> transmittance;
    faces.reserve(solution.triangles.size()), open.reserve(solution.triangles.size());
    for (std::size_t t = 0; t < solution.triangles.size(); ++t) {
        const auto& [a, b, c] = solution.triangles[t];
        faces.push_back({a, b, c, c});
        // The other side of a two-sided surface is a triangle of its own in the same place.
        const SolutionPart& part = solution.parts[part_of_triangle[t]];
        const Material& material = solution.materials[part.material];
        open.push_back(backs == Backs::open || material.two_sided);
        transmittance.push_back(static_cast<float>(material.clear_transmittance()));
    }
    return {points, faces, std::move(open), std::move(transmittance)};
}

}  // namespace

Surfaces::Surfaces(const Solution& solution, Backs backs)
    : solution_(&solution),
      part_of_triangle_(parts_of_triangles(solution)),
      diagonal_(diagonal_of(solution)),
      caster_(caster_of(solution, part_of_triangle_, backs)) {}

std::array<Vec3, 3> Surfaces::corners(std::uint32_t triangle) const {
    const auto& [a, b, c] = solution_->triangles[triangle];
    return {Vec3(solution_->positions[a]), Vec3(solution_->positions[b]),
            Vec3(solution_->positions[c])};
}

void Surfaces::irradiance(const SurfacePlace& place, std::span<double> columns) const {
    const auto& [a, b, c] = solution_->triangles[place.triangle];
    const auto Ha = solution_->irradiance[VertexId(a)], Hb = solution_->irradiance[VertexId(b)],
               Hc = solution_->irradiance[VertexId(c)];
    for (std::size_t i = 0; i < columns.size(); ++i)
        columns[i] = place.weights[0] * double(Ha[i]) + place.weights[1] * double(Hb[i]) +
                     place.weights[2] * double(Hc[i]);
}

}  // namespace exitance
