// SPDX-License-Identifier: Apache-2.0
// Every method against the reference factors that lie beside the project
// (../shared/reference/view_factors.json): polygons, discs, cylinders, spheres, strips, boxes in
// boxes. Curved bodies become facets of equal area, strips are long instead of infinite; what that
// changes is part of the tolerance.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "enclosures.h"
#include "exitance/formfactor/point_polygon.h"

namespace exitance {
namespace {

using enclosures::add;
using enclosures::add_box;
using enclosures::add_rectangle;
using enclosures::compute;
using nlohmann::json;

constexpr double pi = std::numbers::pi;

Vec3 vec3(const json& p) {
    return {p.at(0), p.at(1), p.at(2)};
}

std::vector<Vec3> outline(const json& points) {
    std::vector<Vec3> out;
    for (const json& p : points) out.push_back(vec3(p));
    return out;
}

struct Case {
    Enclosure enclosure{};
    std::uint32_t from = 0;
    std::vector<std::uint32_t> to{1};
    double made_of_facets = 0;  ///< what that changes
    bool touching = false;
    bool many_facets = false;
    bool long_and_thin = false, close = false, obstructed = false;
};

// Radius of the regular n-gon whose area is the disc's.
double ngon_radius(double r, std::size_t n) {
    const double step = 2 * pi / double(n);
    return r * std::sqrt(step / std::sin(step));
}

Vec3 on_circle(const Vec3& centre, double r, std::size_t k, std::size_t n) {
    const double angle = 2 * pi * double(k) / double(n);
    return centre + Vec3{r * std::cos(angle), r * std::sin(angle), 0};
}

constexpr std::size_t sides = 32;

void add_disc(Enclosure& e, const Vec3& centre, double r, bool up, std::uint32_t row) {
    const double R = ngon_radius(r, sides);
    for (std::size_t k = 0; k < sides; ++k) {
        const Vec3 a = on_circle(centre, R, k, sides), b = on_circle(centre, R, k + 1, sides);
        add(e, up ? std::vector{centre, a, b} : std::vector{centre, b, a}, row);
    }
}

// `rows(ring, side)` numbers the facets.
template <class Rows>
void add_sphere(Enclosure& e, const Vec3& centre, double r, bool outside, const Rows& rows) {
    constexpr std::size_t rings = 8, turn = 16;
    // Scaled so that the facets' area is the sphere's.
    const auto at = [&](std::size_t ring, std::size_t k, double scale) {
        const double theta = pi * double(ring) / double(rings);
        return on_circle(centre + Vec3{0, 0, scale * std::cos(theta)}, scale * std::sin(theta), k,
                         turn);
    };
    const auto facets = [&](double scale, const auto& use) {
        for (std::size_t i = 0; i < rings; ++i)
            for (std::size_t k = 0; k < turn; ++k) {
                std::vector<Vec3> f{at(i, k, scale), at(i + 1, k, scale), at(i + 1, k + 1, scale),
                                    at(i, k + 1, scale)};
                if (i == 0) f.erase(f.begin());
                if (i + 1 == rings) f.erase(f.begin() + 2);
                if (!outside) std::reverse(f.begin(), f.end());
                use(f, i, k);
            }
    };
    double whole = 0;
    facets(1, [&](const std::vector<Vec3>& f, std::size_t, std::size_t) { whole += area(f); });
    facets(r * std::sqrt(4 * pi / whole), [&](const std::vector<Vec3>& f, std::size_t i,
                                              std::size_t k) { add(e, f, rows(i, k)); });
}

Case round_bodies(const json& g) {
    Case c;
    c.many_facets = true;
    c.made_of_facets = 4e-3;
    if (g.contains("disk1")) {
        add_disc(c.enclosure, vec3(g["disk1"]["center"]), g["disk1"]["r"], true, 0);
        add_disc(c.enclosure, vec3(g["disk2"]["center"]), g["disk2"]["r"], false, 1);
    } else if (g.contains("cylinder")) {
        const double r = g["cylinder"]["r"], h = g["cylinder"]["h"], R = ngon_radius(r, sides);
        add_disc(c.enclosure, {}, r, true, 0);
        add_disc(c.enclosure, {0, 0, h}, r, false, 2);
        for (std::size_t k = 0; k < sides; ++k) {
            const Vec3 a = on_circle({}, R, k, sides), b = on_circle({}, R, k + 1, sides);
            const Vec3 up{0, 0, h};
            add(c.enclosure, {a, a + up, b + up, b}, 1);
        }
        c.touching = true;
    } else if (g.contains("sphere_cavity")) {
        // Half of the turns of the lower half: a quarter of the sphere.
        add_sphere(c.enclosure, {}, 1, false,
                   [](std::size_t ring, std::size_t k) { return ring >= 4 && k < 8 ? 1U : 0U; });
        c.touching = true;
        c.made_of_facets = 0.01;
    } else if (g.contains("spheres")) {
        add_sphere(c.enclosure, {}, g["spheres"][1], false, [](auto, auto) { return 0U; });
        add_sphere(c.enclosure, {}, g["spheres"][0], true, [](auto, auto) { return 1U; });
        c.to = {0};
        c.touching = true;
        c.made_of_facets = 0.02;
    } else {
        add_sphere(c.enclosure, vec3(g["sphere"]["center"]), g["sphere"]["r"], true,
                   [](auto, auto) { return 0U; });
        add_disc(c.enclosure, vec3(g["disk"]["center"]), g["disk"]["r"], true, 1);
        c.made_of_facets = 6e-3;
    }
    return c;
}

Case strips(const json& g) {
    Case c;
    const double length = 40;
    c.made_of_facets = 1.0 / length;  // what leaves at the ends
    c.long_and_thin = true;
    const Vec3 x{1, 0, 0}, y{0, length, 0};
    add_rectangle(c.enclosure, {}, x, y, 0);
    if (g.contains("angle")) {
        const double angle = g["angle"].get<double>() * pi / 180;
        add_rectangle(c.enclosure, {}, y, Vec3{std::cos(angle), 0, std::sin(angle)}, 1);
        c.touching = true;
    } else {
        add_rectangle(c.enclosure, {0, 0, g.value("h", 1.0)}, y, x, 1);
    }
    if (g.contains("blocker")) {
        const double from = g["blocker"][0], to = g["blocker"][1], height = g["blocker"][2];
        add_rectangle(c.enclosure, {from, 0, height}, x * (to - from), y, Facet::only_blocks);
    }
    return c;
}

Case boxes(const std::string& name) {
    Case c;
    const double s = std::stod(name.substr(name.find("s=") + 2));
    const double low = 0.5 - 0.5 * s;
    add_box(c.enclosure, {}, 1, true, 0);
    add_box(c.enclosure, {low, low, low}, s, false, 6);
    const auto says = [&](const char* what) { return name.find(what) != std::string::npos; };
    c.to = says("whole inner")     ? std::vector<std::uint32_t>{6, 7, 8, 9, 10, 11}
           : says("perpendicular") ? std::vector<std::uint32_t>{8}
           : says("parallel")      ? std::vector<std::uint32_t>{6}
           : says("opposite")      ? std::vector<std::uint32_t>{1}
                                   : std::vector<std::uint32_t>{2};
    c.touching = says("adjacent");
    return c;
}

Case case_of(const json& reference) {
    const json& g = reference.at("geometry");
    if (g.contains("two_d")) return strips(g);
    if (g.contains("outer")) return boxes(reference.at("name"));
    if (!g.contains("P1")) return round_bodies(g);
    Case c;
    const std::vector<Vec3> first = outline(g["P1"]), second = outline(g["P2"]);
    add(c.enclosure, first, 0);
    add(c.enclosure, second, 1);
    if (g.contains("occluder")) add(c.enclosure, outline(g["occluder"]), Facet::only_blocks);
    c.close = std::abs(second[0].z - first[0].z) < 0.2 && first[0].z == first[2].z &&
              second[0].z == second[2].z;
    for (const Vec3& p : first)
        for (const Vec3& q : second) c.touching |= length(p - q) < 1e-9;
    return c;
}

struct Demand {
    double accuracy, tolerance;
};

// What each method is asked for, and by how much it may be off: four standard errors, or what it
// cannot do better (see methods_test.cpp).
Demand demand(const std::string& method, const Case& c) {
    // Exact but for what is partly hidden.
    if (method == "auto") return {1e-6, (c.obstructed ? 1e-5 : 1e-6) + c.made_of_facets};
    const double accuracy = c.many_facets ? 1e-2 : 1e-3;
    double tolerance = 4 * accuracy;
    if (method == "disk") tolerance = c.touching ? 0.03 : 0.012;
    if (method == "hemicube" && c.touching) tolerance = 8e-3;
    // Closer than the cells of a polygon are wide.
    if (c.close && (method == "disk" || method == "hemicube")) tolerance = 0.05;
    // Slices of a disc are no discs.
    if (c.many_facets && method == "disk") tolerance = 0.08;
    return {accuracy, tolerance * double(c.to.size()) + c.made_of_facets};
}

void check_point(const json& reference) {
    const json& g = reference.at("geometry");
    std::vector<Vec3> corners;
    double tolerance = 1e-9;
    if (g.contains("disk")) {
        const double r = ngon_radius(g["disk"]["r"], 1000);
        for (std::size_t k = 1000; k > 0; --k)
            corners.push_back(on_circle(vec3(g["disk"]["center"]), r, k, 1000));
        tolerance = 1e-5;
    } else {
        corners = outline(g["P2"]);
    }
    EXPECT_NEAR(point_polygon_factor(vec3(g["point"]), vec3(g["normal"]), corners),
                reference.at("F12").get<double>(), tolerance)
        << reference.at("name");
}

TEST(ReferenceFactors, AreMetByEveryMethod) {
    std::ifstream file(EXITANCE_SOURCE_DIR "/../shared/reference/view_factors.json");
    if (!file) GTEST_SKIP() << "../shared/reference/view_factors.json is not there";
    for (const json& reference : json::parse(file)) {
        const std::string name = reference.at("name");
        if (reference.at("geometry").contains("point")) {
            check_point(reference);
            continue;
        }
        Case c = case_of(reference);
        c.obstructed = reference.at("obstructed");
        for (const FormFactorMethod& method : form_factor_methods()) {
            const std::string called = method.name;
            if (c.long_and_thin && called == "disk")
                continue;  // theirs are polygons about as long as wide: --by patch makes them
            const Demand wanted = demand(method.name, c);
            MethodOptions options;
            options.accuracy = wanted.accuracy;
            const auto F = enclosures::dense(compute(c.enclosure, method.name, options));
            double sum = 0;
            for (const std::uint32_t to : c.to) sum += F[c.from][to];
            EXPECT_NEAR(sum, reference.at("F12").get<double>(), wanted.tolerance)
                << method.name << ": " << name;
        }
    }
}

}  // namespace
}  // namespace exitance
