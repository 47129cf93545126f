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

std::span<const double> Surfaces::evaluate(const Pattern& pattern, const Spectrum& even,
                                           TexturePoint TextureCoordinates::*which,
                                           const SurfacePlace& place, PatternHere& room) const {
    if (!pattern || solution_->texture_coordinates.empty()) return even;
    double u = 0, v = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const TexturePoint& corner =
            solution_->texture_coordinates[solution_->triangles[place.triangle][i]].*which;
        u += place.weights[i] * double(corner.u), v += place.weights[i] * double(corner.v);
    }
    const Vec3 value = pattern.at({static_cast<float>(u), static_cast<float>(v)});
    room = {value.x, value.y, value.z};
    return room;
}

std::span<const double> Surfaces::reflectance(const SurfacePlace& place, PatternHere& room) const {
    const Material& material = solution_->materials[part(place.triangle).material];
    return evaluate(material.reflectance_pattern, material.reflectance,
                    &TextureCoordinates::reflectance, place, room);
}

std::span<const double> Surfaces::emission(const SurfacePlace& place, PatternHere& room) const {
    const Material& material = solution_->materials[part(place.triangle).material];
    return evaluate(material.exitance_pattern, material.exitance, &TextureCoordinates::exitance,
                    place, room);
}

}  // namespace exitance
