// SPDX-License-Identifier: Apache-2.0
// Solutions made by hand, whose light is known exactly.
#pragma once

#include <functional>
#include <string>

#include "exitance/solution/solution.h"

namespace exitance::hand_made {

/// Irradiance per column at a point of a surface.
using Light = std::function<std::vector<float>(const Vec3& point, const Vec3& normal)>;

inline Solution empty_solution(std::vector<LightGroup> groups = {{"light", 1.0}},
                               std::vector<std::string> bands = {"R", "G", "B"}) {
    Solution s;
    s.title = "made by hand";
    s.quantity = Quantity::radiometric;
    s.bands = std::move(bands);
    s.groups = std::move(groups);
    s.irradiance = VertexField(0, s.columns());
    s.scene_digest = "0123456789abcdef";
    return s;
}

inline std::uint32_t add_material(Solution& s, const std::string& name, Spectrum reflectance,
                                  Spectrum exitance = {}) {
    Material m;
    m.name = name;
    m.reflectance = std::move(reflectance);
    m.exitance = exitance.empty() ? Spectrum(s.bands.size(), 0.0) : std::move(exitance);
    s.materials.push_back(std::move(m));
    return static_cast<std::uint32_t>(s.materials.size() - 1);
}

/// The parallelogram origin + i u + j v as n × m cells of two triangles, facing u × v.
inline void add_sheet(Solution& s, const std::string& name, std::uint32_t material,
                      std::uint32_t group, const Vec3& origin, const Vec3& u, const Vec3& v,
                      std::uint32_t n, std::uint32_t m, const Light& light) {
    const Vec3 normal = normalized(cross(u, v));
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    s.irradiance.resize_rows(first + (n + 1) * (m + 1));
    for (std::uint32_t j = 0; j <= m; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const Vec3 p = origin + u * (double(i) / n) + v * (double(j) / m);
            const std::vector<float> H = light(p, normal);
            std::copy(H.begin(), H.end(), s.irradiance[VertexId(s.positions.size())].begin());
            s.positions.push_back(Vec3f(p));
            s.normals.push_back(Vec3f(normal));
        }
    const auto first_triangle = static_cast<std::uint32_t>(s.triangles.size());
    for (std::uint32_t j = 0; j < m; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = first + j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
            s.triangles.push_back({a, b, c});
            s.triangles.push_back({a, c, d});
        }
    s.parts.push_back({name, material, group, first_triangle, 2 * n * m});
    if (s.materials[material].emits()) {
        Emitter e;
        e.corners = {origin, origin + u, origin + u + v, origin + v};
        e.corner_count = 4;
        e.part = static_cast<std::uint32_t>(s.parts.size() - 1);
        s.emitters.push_back(e);
    }
}

/// The same irradiance `H` in every column everywhere.
inline Light uniform(const Solution& s, double H) {
    return [columns = s.columns(), H](const Vec3&, const Vec3&) {
        return std::vector<float>(columns, static_cast<float>(H));
    };
}

/// The inside of an axis-aligned box, six sheets of n × n cells, all of one material.
inline void add_room(Solution& s, std::uint32_t material, const Vec3& low, const Vec3& high,
                     std::uint32_t n, const Light& light) {
    const Vec3 d = high - low, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    add_sheet(s, "floor", material, 0, low, z, x, n, n, light);
    add_sheet(s, "ceiling", material, 0, low + y, x, z, n, n, light);
    add_sheet(s, "left", material, 0, low, y, z, n, n, light);
    add_sheet(s, "right", material, 0, low + x, z, y, n, n, light);
    add_sheet(s, "back", material, 0, low, x, y, n, n, light);
    add_sheet(s, "front", material, 0, low + z, y, x, n, n, light);
}

}  // namespace exitance::hand_made
