// SPDX-License-Identifier: Apache-2.0
// Rooms for whole solves, and how two solutions are compared.
#pragma once

#include <cmath>
#include <string>

#include "exitance/pipeline.h"
#include "scene/small_scenes.h"

namespace exitance::solve_scenes {

/// The inside of [low, high] with one material of reflectance `rho`.
inline void add_room(Scene& scene, const Vec3& low, const Vec3& high, double rho,
                     double exitance = 0) {
    const auto s = testing::add_surface(scene, "room", rho, exitance);
    const auto [a, b, c] = low;
    const auto [x, y, z] = high;
    testing::add_polygon(scene, s, {{a, b, c}, {x, b, c}, {x, y, c}, {a, y, c}});
    testing::add_polygon(scene, s, {{a, b, z}, {a, y, z}, {x, y, z}, {x, b, z}});
    testing::add_polygon(scene, s, {{a, b, c}, {a, b, z}, {x, b, z}, {x, b, c}});
    testing::add_polygon(scene, s, {{a, y, c}, {x, y, c}, {x, y, z}, {a, y, z}});
    testing::add_polygon(scene, s, {{a, b, c}, {a, y, c}, {a, y, z}, {a, b, z}});
    testing::add_polygon(scene, s, {{x, b, c}, {x, b, z}, {x, y, z}, {x, y, c}});
}

/// A square lamp of `side` around (x, y) at height z, facing down.
inline void add_lamp(Scene& scene, const std::string& name, const Vec3& at, double side,
                     const Spectrum& exitance) {
    const auto s = testing::add_surface(scene, name, 0);
    scene.materials[scene.surfaces[s].material].exitance = exitance;
    scene.materials[scene.surfaces[s].material].group = name;
    testing::add_square(scene, s, at.x - side / 2, at.y - side / 2, at.z, side, true);
}

/// A one-sided block that stands on z = low.z, without a bottom.
inline void add_block(Scene& scene, const Vec3& low, const Vec3& high, double rho) {
    const auto s = testing::add_surface(scene, "block", rho);
    const auto [a, b, c] = low;
    const auto [x, y, z] = high;
    testing::add_polygon(scene, s, {{a, b, z}, {x, b, z}, {x, y, z}, {a, y, z}});
    testing::add_polygon(scene, s, {{a, b, c}, {x, b, c}, {x, b, z}, {a, b, z}});
    testing::add_polygon(scene, s, {{a, y, c}, {a, y, z}, {x, y, z}, {x, y, c}});
    testing::add_polygon(scene, s, {{a, b, c}, {a, b, z}, {a, y, z}, {a, y, c}});
    testing::add_polygon(scene, s, {{x, b, c}, {x, y, c}, {x, y, z}, {x, b, z}});
}

/// Two lamps of different colour under the ceiling; a block casts shadows of both.
inline Scene two_lamp_room(bool block = true) {
    Scene scene;
    add_room(scene, {}, {3, 2, 2}, 0.6);
    add_lamp(scene, "warm", {0.7, 1, 1.95}, 0.4, {30, 20, 5});
    add_lamp(scene, "cold", {2.4, 0.7, 1.95}, 0.3, {5, 20, 40});
    if (block) add_block(scene, {1.2, 0.8, 0}, {1.8, 1.3, 0.7}, 0.4);
    return scene;
}

/// Σ w (a − b)² and Σ w a over vertices with the areas they stand for.
struct Comparison {
    double rms = 0;    ///< of the difference, relative to the mean of the first
    double worst = 0;  ///< largest difference, relative to the same
    double bias = 0;   ///< mean difference, relative to the same
};

inline std::vector<double> vertex_areas(const Solution& s) {
    std::vector<double> areas(s.positions.size(), 0.0);
    for (const auto& t : s.triangles) {
        const Vec3 a(s.positions[t[0]]);
        const double area =
            0.5 * length(cross(Vec3(s.positions[t[1]]) - a, Vec3(s.positions[t[2]]) - a));
        for (const std::uint32_t v : t) areas[v] += area / 3;
    }
    return areas;
}

/// Of two solutions on the same mesh: column `ca` of `a` against column `cb` of `b`.
inline Comparison compare(const Solution& a, const Solution& b, std::size_t ca, std::size_t cb) {
    Comparison out;
    const std::vector<double> areas = vertex_areas(a);
    double square = 0, sum = 0, difference = 0, area = 0, worst = 0;
    for (std::size_t v = 0; v < areas.size(); ++v) {
        const double x = double(a.irradiance[VertexId(v)][ca]),
                     y = double(b.irradiance[VertexId(v)][cb]);
        square += areas[v] * (x - y) * (x - y);
        difference += areas[v] * (y - x);
        sum += areas[v] * x, area += areas[v];
        worst = std::max(worst, std::abs(x - y));
    }
    const double mean = sum / area;
    out.rms = std::sqrt(square / area) / mean;
    out.worst = worst / mean;
    out.bias = difference / area / mean;
    return out;
}

inline double mean_irradiance(const Solution& s, std::size_t column, std::size_t part_index) {
    const SolutionPart& part = s.parts[part_index];
    double sum = 0, area = 0;
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangles; ++t) {
        const auto [i, j, k] = s.triangles[t];
        const Vec3 a(s.positions[i]);
        const double A = 0.5 * length(cross(Vec3(s.positions[j]) - a, Vec3(s.positions[k]) - a));
        for (const std::uint32_t v : {i, j, k})
            sum += A / 3 * double(s.irradiance[VertexId(v)][column]);
        area += A;
    }
    return sum / area;
}

inline bool all_finite(const Solution& s) {
    for (const float x : s.irradiance.values())
        if (!std::isfinite(x)) return false;
    return true;
}

}  // namespace exitance::solve_scenes
