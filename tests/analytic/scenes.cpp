// SPDX-License-Identifier: Apache-2.0
#include "analytic/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <ostream>
#include <span>

#include "analytic/luminaire_scenes.h"
#include "analytic/plate_scenes.h"
#include "exitance/math/polygon.h"
#include "exitance/run/random.h"

namespace exitance::analytic {

namespace {

Material diffuse(const Spectrum& reflectance, const Spectrum& exitance, bool two_sided = false) {
    Material material;
    material.reflectance = reflectance;
    material.exitance = exitance;
    material.two_sided = two_sided;
    return material;
}

std::uint32_t add_surface(Scene& scene, const std::string& name, Material material) {
    material.name = name;
    return scene.add_surface(name, scene.add_material(std::move(material)));
}

void add_polygon(Scene& scene, std::uint32_t surface, std::span<const Vec3> corners) {
    Polygon polygon;
    polygon.surface = surface;
    for (std::size_t i = 0; i < corners.size(); ++i)
        polygon.corners[i] = scene.add_point(corners[i]);
    scene.polygons.push_back(polygon);
}

void add_polygon(Scene& scene, std::uint32_t surface, std::initializer_list<Vec3> corners) {
    add_polygon(scene, surface, std::span<const Vec3>(corners.begin(), corners.size()));
}

/// The six sides of a block; `inside` turns them to face its interior.
void add_block(Scene& scene, std::uint32_t surface, const Vec3& low, const Vec3& high, bool inside,
               bool bottom = true) {
    const auto [x0, y0, z0] = low;
    const auto [x1, y1, z1] = high;
    std::vector<std::array<Vec3, 4>> faces{
        {{{x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}}},
        {{{x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}}},
        {{{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}}},
        {{{x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}, {x1, y1, z0}}},
        {{{x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}, {x0, y1, z0}}},
        {{{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}}}};
    if (!bottom) faces.erase(faces.begin());
    for (auto& face : faces) {
        if (inside) std::reverse(face.begin(), face.end());
        add_polygon(scene, surface, face);
    }
}

/// Middle, off-centre, beside an edge and in a corner of every side of a room from 0 to `size`.
void add_probes_in_room(Case& c, const Vec3& size) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true})
            for (const auto& [s, t] : std::array<std::array<double, 2>, 4>{
                     {{0.5, 0.5}, {0.31, 0.77}, {0.001, 0.4}, {0.9995, 0.0005}}}) {
                Vec3 position, normal;
                position[axis] = far ? size[axis] : 0;
                position[(axis + 1) % 3] = s * size[(axis + 1) % 3];
                position[(axis + 2) % 3] = t * size[(axis + 2) % 3];
                normal[axis] = far ? -1 : 1;
                c.add_probe(position, normal);
            }
}

const Spectrum grey_rho{0.95, 0.8, 0.5};

/// Where sources are partly hidden, samples of their visibility leave an error in the sum of a
/// row's form factors, and n reflections carry it n times: these scenes reflect half, in all bands
/// alike, because the error that a solver is asked for is one of the bands' luminance.
const Spectrum half_rho{0.5, 0.5, 0.5};
const Spectrum half_irradiance{2, 2, 2};  // 1 / (1 - rho)

Case closed_box(const std::string& name, const Vec3& size, const Spectrum& rho = grey_rho) {
    Case c;
    c.name = name;
    add_block(c.scene, add_surface(c.scene, "wall", diffuse(rho, {1, 1, 1})), {}, size, true);
    Spectrum irradiance;
    for (const double r : rho) irradiance.push_back(1 / (1 - r));
    c.exact = [irradiance](const Vec3&, const Vec3&) { return irradiance; };
    add_probes_in_room(c, size);
    c.why =
        "in a closed room of uniform E and rho the irradiance is E / (1 - rho) everywhere; 1 % for "
        "sampling and stopping, at rho = 0.95 after some 60 reflections";
    return c;
}

Case furnished_box() {
    Case c = closed_box("furnished_box", {1.5, 1, 0.8}, half_rho);
    add_block(c.scene, 0, {0.3, 0.2, 0}, {0.7, 0.5, 0.4}, false, false);
    add_block(c.scene, 0, {0.9, 0.55, 0}, {1.2, 0.9, 0.15}, false, false);
    c.exact = [](const Vec3& at, const Vec3&) -> std::optional<Spectrum> {
        const auto under = [&](double x0, double x1, double y0, double y1) {
            return x0 < at.x && at.x < x1 && y0 < at.y && at.y < y1 && at.z < 1e-6;
        };
        if (under(0.3, 0.7, 0.2, 0.5) || under(0.9, 1.2, 0.55, 0.9)) return {};
        return half_irradiance;
    };
    c.add_probe({0.5, 0.35, 0.4}, {0, 0, 1});
    c.add_probe({0.3, 0.35, 0.001}, {-1, 0, 0});
    c.add_probe({0.295, 0.35, 0}, {0, 0, 1});
    c.add_probe({0.9, 0.7, 0.05}, {-1, 0, 0});
    c.tolerance = 0.04, c.error = 0.02, c.imbalance = 0.01;
    c.why =
        "blocks of the same E and rho on the floor change nothing, contacts included; "
        "2 % RMS is asked for, and 30 places lie within twice that";
    return c;
}

Case sheet_in_a_box() {
    Case c = closed_box("sheet_in_a_box", {1, 1, 1}, half_rho);
    const auto sheet = add_surface(c.scene, "sheet", diffuse(half_rho, {1, 1, 1}, true));
    add_polygon(c.scene, sheet,
                {{0.2, 0.3, 0.5}, {0.8, 0.3, 0.6}, {0.8, 0.7, 0.6}, {0.2, 0.7, 0.5}});
    const Vec3 up = normalized(Vec3{-0.1, 0, 0.6});
    for (const Vec3& normal : {up, -up}) {
        c.add_probe({0.5, 0.5, 0.55}, normal);
        c.add_probe({0.203, 0.65, 0.5005}, normal);
    }
    c.tolerance = 0.03, c.error = 0.01, c.imbalance = 0.01;
    c.why =
        "a two-sided sheet of the same E and rho on both sides changes nothing; 1 % RMS is "
        "asked for, and 28 places lie within 3 %";
    return c;
}

/// A latitude-longitude sphere seen from inside, every facet with its own E and rho.
Case sphere() {
    constexpr std::uint32_t rows = 16, columns = 32;
    Case c;
    c.name = "sphere_interior";
    const auto at = [](std::uint32_t i, std::uint32_t j) {
        const double theta = std::numbers::pi * i / rows;
        const double phi = 2 * std::numbers::pi * (j % columns) / columns;
        const double ring = i == 0 || i == rows ? 0.0 : std::sin(theta);
        return Vec3{ring * std::cos(phi), ring * std::sin(phi), std::cos(theta)};
    };
    double total = 0;
    Spectrum emitted(3), reflected(3);
    std::vector<std::array<Vec3, 2>> candidates;
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            std::vector<Vec3> corners;
            if (i == 0)
                corners = {at(0, 0), at(1, j + 1), at(1, j)};
            else if (i + 1 == rows)
                corners = {at(i, j), at(i, j + 1), at(rows, 0)};
            else
                corners = {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)};
            const std::uint64_t facet = hash_bits(std::uint64_t{i} * columns + j);
            Spectrum rho(3), E(3);
            for (std::size_t b = 0; b < 3; ++b) {
                rho[b] = 0.9 * uniform(facet, b);
                E[b] = uniform(facet, 7) < 0.2 ? 10 * uniform(facet, 3 + b) : 0.0;
            }
            const double A = area(corners);
            total += A;
            for (std::size_t b = 0; b < 3; ++b) emitted[b] += A * E[b], reflected[b] += A * rho[b];
            const std::string name = "facet " + std::to_string(i * columns + j);
            add_polygon(c.scene, add_surface(c.scene, name, diffuse(rho, E)), corners);
            if (facet % 23 == 0) candidates.push_back({centroid(corners), unit_normal(corners)});
        }
    Spectrum exact(3);
    for (std::size_t b = 0; b < 3; ++b) exact[b] = emitted[b] / (total - reflected[b]);
    c.exact = [exact](const Vec3&, const Vec3&) { return exact; };
    for (const auto& [position, normal] : candidates) c.add_probe(position, normal);
    c.tolerance = 0.03;
    c.departure = 0.0090;  // path-traced, 3000 points of 8192 paths
    c.why =
        "every point of a sphere sees dA' with the factor dA' / A, so H = <E> / (1 - <rho>), "
        "averages by area; 16 x 32 facets depart from the sphere by 0.5 % of its radius, and a "
        "lit neighbour in one plane with a facet's corner is seen up to 2 % differently";
    return c;
}

}  // namespace

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

std::vector<Case> closed_form_cases() {
    std::vector<Case> cases{closed_box("closed_box", {1, 1, 1}),
                            closed_box("flat_box", {4, 1, 0.25}), furnished_box(), sheet_in_a_box(),
                            sphere()};
    for (std::vector<Case> more : {plate_cases(), luminaire_cases()})
        std::move(more.begin(), more.end(), std::back_inserter(cases));
    return cases;
}

}  // namespace exitance::analytic
