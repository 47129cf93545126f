// SPDX-License-Identifier: Apache-2.0
#include "analytic/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <span>

#include "analytic/configuration_factors.h"
#include "analytic/luminaire_scenes.h"
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

Material diffuse(double reflectance, double exitance) {
    return diffuse(Spectrum(3, reflectance), Spectrum(3, exitance));
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
std::vector<Probe> probes_in_room(const Vec3& size, const Spectrum& irradiance) {
    std::vector<Probe> probes;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true})
            for (const auto& [s, t] : std::array<std::array<double, 2>, 4>{
                     {{0.5, 0.5}, {0.31, 0.77}, {0.001, 0.4}, {0.9995, 0.0005}}}) {
                Vec3 position, normal;
                position[axis] = far ? size[axis] : 0;
                position[(axis + 1) % 3] = s * size[(axis + 1) % 3];
                position[(axis + 2) % 3] = t * size[(axis + 2) % 3];
                normal[axis] = far ? -1 : 1;
                probes.push_back({position, normal, irradiance});
            }
    return probes;
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
    c.probes = probes_in_room(size, irradiance);
    c.why =
        "in a closed room of uniform E and rho the irradiance is E / (1 - rho) everywhere; 1 % for "
        "sampling and stopping, at rho = 0.95 after some 60 reflections";
    return c;
}

Case furnished_box() {
    Case c = closed_box("furnished_box", {1.5, 1, 0.8}, half_rho);
    add_block(c.scene, 0, {0.3, 0.2, 0}, {0.7, 0.5, 0.4}, false, false);
    add_block(c.scene, 0, {0.9, 0.55, 0}, {1.2, 0.9, 0.15}, false, false);
    c.probes.push_back({{0.5, 0.35, 0.4}, {0, 0, 1}, half_irradiance});
    c.probes.push_back({{0.3, 0.35, 0.001}, {-1, 0, 0}, half_irradiance});
    c.probes.push_back({{0.295, 0.35, 0}, {0, 0, 1}, half_irradiance});
    c.probes.push_back({{0.9, 0.7, 0.05}, {-1, 0, 0}, half_irradiance});
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
        c.probes.push_back({{0.5, 0.5, 0.55}, normal, half_irradiance});
        c.probes.push_back({{0.203, 0.65, 0.5005}, normal, half_irradiance});
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
    std::vector<Probe> candidates;
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
            if (facet % 23 == 0)
                candidates.push_back({centroid(corners), unit_normal(corners), {}});
        }
    Spectrum exact(3);
    for (std::size_t b = 0; b < 3; ++b) exact[b] = emitted[b] / (total - reflected[b]);
    for (Probe& probe : candidates) probe.irradiance = exact;
    c.probes = candidates;
    c.tolerance = 0.03;
    c.why =
        "every point of a sphere sees dA' with the factor dA' / A, so H = <E> / (1 - <rho>), "
        "averages by area; 16 x 32 facets depart from the sphere by 0.5 % of its radius, and a "
        "lit neighbour in one plane with a facet's corner is seen up to 2 % differently";
    return c;
}

/// Two unit squares face to face, E and rho uniform on each.
struct Plates {
    double distance, E1, rho1, E2, rho2;
};

/// Irradiance of both plates at (x, y), by Nyström's method: the two integral equations on 12 × 12
/// Gauss points per plate, iterated until they stand still.
class PlatesExactly {
  public:
    explicit PlatesExactly(const Plates& plates) : plates_(plates) {
        make_rule();
        B1_.assign(nodes_.size(), plates.E1);
        B2_.assign(nodes_.size(), plates.E2);
        for (int sweep = 0; sweep < 60; ++sweep) {
            for (std::size_t i = 0; i < nodes_.size(); ++i)
                B2_[i] = plates.E2 + plates.rho2 * gather(nodes_[i].x, nodes_[i].y, B1_);
            for (std::size_t i = 0; i < nodes_.size(); ++i)
                B1_[i] = plates.E1 + plates.rho1 * gather(nodes_[i].x, nodes_[i].y, B2_);
        }
    }
    double on_first(double x, double y) const { return gather(x, y, B2_); }
    double on_second(double x, double y) const { return gather(x, y, B1_); }

  private:
    struct Node {
        double x, y, weight;
    };

    void make_rule() {
        constexpr int n = 12;
        std::array<double, n> abscissa, weight;
        for (int i = 0; i < n; ++i) {  // Newton's method on the Legendre polynomial P_n
            double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
            for (int step = 0; step < 20; ++step) {
                double before = 1, P = x;
                for (int k = 2; k <= n; ++k) {
                    const double next = ((2 * k - 1) * x * P - (k - 1) * before) / k;
                    before = P, P = next;
                }
                slope = n * (x * P - before) / (x * x - 1);
                x -= P / slope;
            }
            abscissa[static_cast<std::size_t>(i)] = (x + 1) / 2;
            weight[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                nodes_.push_back({abscissa[i], abscissa[j], weight[i] * weight[j]});
    }
    double gather(double x, double y, const std::vector<double>& B) const {
        const double h2 = plates_.distance * plates_.distance;
        double H = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const double dx = nodes_[i].x - x, dy = nodes_[i].y - y;
            const double r2 = dx * dx + dy * dy + h2;
            H += nodes_[i].weight * B[i] * h2 / (std::numbers::pi * r2 * r2);
        }
        return H;
    }

    Plates plates_;
    std::vector<Node> nodes_;
    std::vector<double> B1_, B2_;
};

Case two_plates() {
    // Form factor 1/3, as in the lectures' example (12.5217 and 2.0870 with one value per plate).
    const Plates plates{0.6399438604918362, 12, 0.75, 0, 0.5};
    const PlatesExactly exact(plates);
    Case c;
    c.name = "two_plates";
    const double h = plates.distance;
    add_polygon(c.scene, add_surface(c.scene, "ceiling", diffuse(plates.rho1, plates.E1)),
                {{0, 0, h}, {0, 1, h}, {1, 1, h}, {1, 0, h}});
    add_polygon(c.scene, add_surface(c.scene, "floor", diffuse(plates.rho2, plates.E2)),
                {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    for (const auto& [x, y] : std::array<std::array<double, 2>, 5>{
             {{0.5, 0.5}, {0.25, 0.4}, {0.8, 0.9}, {0.5, 0.01}, {0.005, 0.995}}}) {
        c.probes.push_back({{x, y, h}, {0, 0, -1}, Spectrum(3, exact.on_first(x, y))});
        c.probes.push_back({{x, y, 0}, {0, 0, 1}, Spectrum(3, exact.on_second(x, y))});
    }
    c.why = "two coupled integral equations, solved to 1e-6 by Gauss quadrature";
    return c;
}

Case parallel_plates() {
    Case c;
    c.name = "parallel_plates";
    c.error = 0.005;  // the lamp is so near that its edge is nearly a step
    add_polygon(c.scene, add_surface(c.scene, "lamp", diffuse(0, 100)),
                {{0, 0, 0.3}, {0, 1, 0.3}, {2, 1, 0.3}, {2, 0, 0.3}});
    add_polygon(c.scene, add_surface(c.scene, "floor", diffuse(0.5, 0)),
                {{-1, -1, 0}, {3, -1, 0}, {3, 2, 0}, {-1, 2, 0}});
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{1, 0.5}, {0, 0}, {1.9, 0.2}, {-0.4, 0.5}, {2.9, 1.9}, {1, 1.03}}})
        c.probes.push_back({{x, y, 0},
                            {0, 0, 1},
                            Spectrum(3, 100 * parallel_rectangle(-x, 2 - x, -y, 1 - y, 0.3))});
    c.why = "a black lamp sends nothing back: 100 F of Howell B-3; 1 % for interpolation";
    return c;
}

Case perpendicular_plates() {
    Case c;
    c.name = "perpendicular_plates";
    add_polygon(c.scene, add_surface(c.scene, "wall", diffuse(0, 100)),
                {{0, 0, 0}, {0, 2, 0}, {0, 2, 1}, {0, 0, 1}});
    add_polygon(c.scene, add_surface(c.scene, "floor", diffuse(0.7, 0)),
                {{0, 0, 0}, {1.5, 0, 0}, {1.5, 2, 0}, {0, 2, 0}});
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{0.5, 1}, {0.1, 0.7}, {0.02, 1.5}, {0.05, 0.02}, {1.4, 1.9}, {1, 0.3}}})
        c.probes.push_back({{x, y, 0},
                            {0, 0, 1},
                            Spectrum(3, 100 * (perpendicular_rectangle(1, y, x) +
                                               perpendicular_rectangle(1, 2 - y, x)))});
    c.why =
        "a black lamp sends nothing back: 100 F of Howell B-4, which tends to 1/2 at the common "
        "edge; 1 % for interpolation";
    return c;
}

/// Irradiance of an unoccluded polygon of uniform exitance wholly above the horizon (Lambert 1760).
double lambert(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = normalized(corners[i] - point);
        const Vec3 b = normalized(corners[(i + 1) % corners.size()] - point);
        const double angle = std::atan2(length(cross(a, b)), dot(a, b));
        sum += angle * dot(normalized(cross(a, b)), normal);
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

Case tilted_lamp() {
    Case c;
    c.name = "tilted_lamp";
    const std::array<Vec3, 3> lamp{{{0.3, 0.2, 0.5}, {0.1, 0.8, 0.9}, {0.9, 0.4, 0.6}}};
    add_polygon(c.scene, add_surface(c.scene, "lamp", diffuse(0, 40)), lamp);
    add_polygon(c.scene, add_surface(c.scene, "floor", diffuse(0.3, 0)),
                {{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}});
    const Vec3 facing = unit_normal(lamp);
    for (const auto& [x, y] : std::array<std::array<double, 2>, 5>{
             {{0.4, 0.4}, {0.1, 0.1}, {0.6, -0.5}, {1.2, 0.6}, {-0.8, -0.8}}}) {
        const Vec3 point{x, y, 0};
        const double lit = dot(facing, point - lamp[0]) > 0 ? 1 : 0;  // the back is black
        c.probes.push_back(
            {point, {0, 0, 1}, Spectrum(3, 40 * lit * lambert(point, {0, 0, 1}, lamp))});
    }
    c.why =
        "a triangle of uniform exitance above a floor: Lambert's formula; 1 % for interpolation";
    return c;
}

Case occluded_square() {
    // Lamp [-1,1]² at z = 2, black square [-0.4,0.4]² at z = 1. Seen from (x, y, 0) the square
    // covers [-0.8 - x, 0.8 - x] × [-0.8 - y, 0.8 - y] of the lamp's plane.
    Case c;
    c.name = "occluded_square";
    add_polygon(c.scene, add_surface(c.scene, "lamp", diffuse(0, 100)),
                {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
    Material black = diffuse(0, 0);
    black.two_sided = true;
    add_polygon(c.scene, add_surface(c.scene, "square", black),
                {{-0.4, -0.4, 1}, {0.4, -0.4, 1}, {0.4, 0.4, 1}, {-0.4, 0.4, 1}});
    add_polygon(c.scene, add_surface(c.scene, "floor", diffuse(0.5, 0)),
                {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
    for (const auto& [x, y] : std::array<std::array<double, 2>, 7>{
             {{0, 0}, {0.3, 0.1}, {0.7, 0}, {1.2, 0.9}, {1.7, 0.2}, {2.4, 2.4}, {-1, 0.5}}}) {
        const double x0 = std::clamp(-0.8 - x, -1.0, 1.0), x1 = std::clamp(0.8 - x, -1.0, 1.0);
        const double y0 = std::clamp(-0.8 - y, -1.0, 1.0), y1 = std::clamp(0.8 - y, -1.0, 1.0);
        const double whole = parallel_rectangle(-1 - x, 1 - x, -1 - y, 1 - y, 2);
        const double hidden = parallel_rectangle(x0 - x, x1 - x, y0 - y, y1 - y, 2);
        c.probes.push_back({{x, y, 0}, {0, 0, 1}, Spectrum(3, 100 * (whole - hidden))});
    }
    c.tolerance = 0.02;
    c.why =
        "lamp minus the part that the square hides, both Howell B-3; 2 % for interpolation across "
        "the penumbra";
    return c;
}

}  // namespace

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

std::vector<Case> closed_form_cases() {
    std::vector<Case> cases{closed_box("closed_box", {1, 1, 1}),
                            closed_box("flat_box", {4, 1, 0.25}),
                            furnished_box(),
                            sheet_in_a_box(),
                            sphere(),
                            two_plates(),
                            parallel_plates(),
                            perpendicular_plates(),
                            tilted_lamp(),
                            occluded_square()};
    for (Case& c : luminaire_cases()) cases.push_back(std::move(c));
    return cases;
}

}  // namespace exitance::analytic
