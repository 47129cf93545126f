// SPDX-License-Identifier: Apache-2.0
// What is closed in the input is closed in the solution, however the mesh was divided: every edge
// of the triangulation is walked as often one way as the other, and no vertex lies inside an edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "exitance/scene/read.h"
#include "exitance/solution/extract.h"
#include "exitance/solve/radiosity.h"
#include "mesh/mesh_scenes.h"

namespace exitance {
namespace {

using namespace mesh_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_surface;

using Bits = std::array<std::uint32_t, 3>;
Bits bits_of(const Vec3f& p) {
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

// Directed edges of the triangles by the bits of their ends, and how often each is walked.
std::map<std::array<Bits, 2>, int> edges_of(const Solution& solution) {
    std::map<std::array<Bits, 2>, int> edges;
    for (const auto& t : solution.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++edges[{bits_of(solution.positions[t[i]]),
                     bits_of(solution.positions[t[(i + 1) % 3]])}];
    return edges;
}

// Edges that are not walked equally often both ways: the borders of what is open.
std::size_t open_edges(const Solution& solution) {
    const auto edges = edges_of(solution);
    std::size_t open = 0;
    for (const auto& [edge, count] : edges) {
        const auto reverse = edges.find({edge[1], edge[0]});
        open += reverse == edges.end() || reverse->second != count;
    }
    return open;
}

// The triangles that face along `direction` or across it.
Solution facing(const Solution& solution, const Vec3f& direction) {
    Solution out = solution;
    std::erase_if(out.triangles, [&](const std::array<std::uint32_t, 3>& t) {
        const Vec3f a = solution.positions[t[0]];
        return dot(cross(solution.positions[t[1]] - a, solution.positions[t[2]] - a), direction) <
               0;
    });
    return out;
}

// Vertices strictly inside an edge of a triangle, nearer than a millionth of its length.
std::size_t t_vertices(const Solution& solution) {
    std::map<Bits, Vec3> places;
    for (const auto& t : solution.triangles)
        for (const std::uint32_t v : t)
            places[bits_of(solution.positions[v])] = Vec3(solution.positions[v]);
    std::vector<Vec3> by_x;
    for (const auto& [bits, p] : places) by_x.push_back(p);
    std::sort(by_x.begin(), by_x.end(), [](const Vec3& a, const Vec3& b) { return a.x < b.x; });
    std::size_t found = 0;
    for (const auto& [edge, count] : edges_of(solution)) {
        const Vec3 a = places.at(edge[0]), b = places.at(edge[1]), d = b - a;
        const double slack = 1e-6 * length(d);
        const double low = std::min(a.x, b.x) - slack, high = std::max(a.x, b.x) + slack;
        auto p = std::lower_bound(by_x.begin(), by_x.end(), low,
                                  [](const Vec3& q, double x) { return q.x < x; });
        for (; p != by_x.end() && p->x <= high; ++p) {
            const double t = dot(*p - a, d) / dot(d, d);
            if (t <= 1e-6 || t >= 1 - 1e-6) continue;
            found += length(*p - a - d * t) < slack;
        }
    }
    return found;
}

Radiosity radiosity_of(const Scene& scene, double patch_size = 10) {
    return Radiosity(scene, make_groups(scene, Grouping::none), {patch_size, true, 0.1});
}

void expect_watertight(const Scene& scene) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        Radiosity radiosity = radiosity_of(scene);
        const auto check = [&](const char* after) {
            radiosity.admit_new_vertices();
            const Solution solution = extract_solution(radiosity);
            EXPECT_EQ(open_edges(solution), 0u) << "seed " << seed << " " << after;
            // The two sides of a sheet cover each other and meet along its outline alone.
            for (const float z : {1.0f, -1.0f})
                EXPECT_EQ(t_vertices(facing(solution, {0.1f, 0.2f, z})), 0u)
                    << "seed " << seed << " " << after;
        };
        check("undivided");
        split_at_random(radiosity.mesh, seed, 60);
        check("after splits");
        merge_at_random(radiosity.mesh, seed);
        check("after merges");
        split_at_random(radiosity.mesh, seed + 50, 20);
        check("after further splits");
    }
}

TEST(Watertight, ClosedBoxWithUnequalWalls) {
    expect_watertight(box({1, 2, 3}, {1, 2, 3, 4, 5, 7}));
    expect_watertight(box({0.3, 0.7, 1.1}, {6, 10, 15, 1, 1, 49}));
}

TEST(Watertight, CubeOfTrianglesOfDifferentDivision) {
    expect_watertight(triangle_cube());
}

TEST(Watertight, SmoothSphere) {
    expect_watertight(sphere(0));
    expect_watertight(sphere(2));
}

// The border of the sheet is closed by its other side.
TEST(Watertight, BothSidesOfASheet) {
    expect_watertight(two_sided_sheet());
}

TEST(Watertight, TurnedAndFarFromTheOrigin) {
    // Coordinates that are no round numbers: places on an edge must come from its ends alone.
    Scene scene = triangle_cube();
    const Vec3 x = normalized(Vec3{1, 0.2, -0.4}), y = normalized(cross({0.1, 0.3, 1}, x)),
               z = cross(x, y);
    for (Vec3& p : scene.points) p = Vec3{7.3, -3.1, 12.7} + x * p.x + y * p.y + z * p.z;
    expect_watertight(scene);
}

TEST(Watertight, PartedByWallsThatStandOnIt) {
    // The walls' own borders lie on the room's surfaces, so only the room's edges are counted.
    const Scene room = box({1, 2, 3}, {1, 2, 3, 4, 5, 7});
    Scene scene = room;
    const auto wall = add_surface(scene, "partition", 0.5);
    add_polygon(scene, wall, {{0.4, 0, 0}, {0.4, 0.7, 0}, {0.4, 0.7, 3}, {0.4, 0, 3}});
    add_polygon(scene, wall, {{0.4, 0.7, 0}, {1, 0.9, 0}, {1, 0.9, 3}, {0.4, 0.7, 3}});
    add_polygon(scene, wall, {{0.1, 0.2, 0}, {0.3, 1.5, 0}, {0.3, 1.5, 1}});
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        Radiosity radiosity = radiosity_of(scene);
        const auto check = [&](const char* after) {
            radiosity.admit_new_vertices();
            Solution solution = extract_solution(radiosity);
            const SolutionPart& partition = solution.parts.back();
            ASSERT_EQ(partition.name, "partition");
            solution.triangles.resize(partition.first_triangle);
            EXPECT_EQ(open_edges(solution), 0u) << "seed " << seed << " " << after;
            EXPECT_EQ(t_vertices(solution), 0u) << "seed " << seed << " " << after;
        };
        check("undivided");
        split_at_random(radiosity.mesh, seed, 60);
        check("after splits");
        merge_at_random(radiosity.mesh, seed);
        check("after merges");
    }
}

TEST(Watertight, DownToTheFinestLevelAtEveryCorner) {
    const Scene scene = box({1, 1, 1}, {1, 1, 1, 1, 1, 1});
    Radiosity radiosity = radiosity_of(scene);
    for (std::size_t corner = 0; corner < 4; ++corner)
        for (const std::size_t wall : {0u, 2u}) {
            ElementId leaf = radiosity.mesh.patches()[wall].root;
            while (true) {
                radiosity.mesh.split(leaf);
                if (radiosity.mesh[leaf].leaf()) break;
                leaf = ElementId(radiosity.mesh[leaf].first_child.index() + corner);
            }
            EXPECT_EQ(radiosity.mesh[leaf].level, Mesh::max_level);
        }
    radiosity.admit_new_vertices();
    const Solution solution = extract_solution(radiosity);
    EXPECT_EQ(open_edges(solution), 0u);
}

TEST(Watertight, DownToTheFinestLevelOfATriangle) {
    const Scene scene = triangle_cube();
    Radiosity radiosity = radiosity_of(scene);
    for (std::size_t corner = 0; corner < 3; ++corner)
        for (const std::size_t patch : {0u, 1u}) {
            ElementId leaf = radiosity.mesh.patches()[patch].root;
            while (true) {
                radiosity.mesh.split(leaf);
                if (radiosity.mesh[leaf].leaf()) break;
                leaf = ElementId(radiosity.mesh[leaf].first_child.index() + corner);
            }
        }
    radiosity.admit_new_vertices();
    EXPECT_EQ(open_edges(extract_solution(radiosity)), 0u);
}

TEST(Watertight, CornellBox) {
    // Its measured walls do not meet exactly, so some edges are open; there must be no T-vertex
    // that the input does not have, and division must not add open edges inside surfaces.
    const Scene scene =
        read_scene(std::filesystem::path(EXITANCE_SOURCE_DIR) / "scenes/cornell.toml");
    Radiosity radiosity = radiosity_of(scene, 0.3);
    const auto before = open_edges(extract_solution(radiosity));
    split_at_random(radiosity.mesh, 3, 100);
    radiosity.admit_new_vertices();
    const Solution solution = extract_solution(radiosity);
    // An open edge of the input may be divided; a crack inside a surface would be an open edge
    // whose ends are not both on an input edge.
    const auto on_border = [&](const Vec3& p) {
        for (const Polygon& polygon : scene.polygons) {
            const auto corners = scene.corners(polygon);
            for (std::uint32_t i = 0; i < polygon.size(); ++i) {
                const Vec3 a = corners[i], d = corners[(i + 1) % polygon.size()] - a;
                const double t = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
                if (length(p - a - d * t) < 1e-6) return true;
            }
        }
        return false;
    };
    const auto edges = edges_of(solution);
    std::size_t open = 0, cracks = 0;
    for (const auto& [edge, count] : edges) {
        const auto reverse = edges.find({edge[1], edge[0]});
        if (reverse != edges.end() && reverse->second == count) continue;
        ++open;
        const auto place = [](const Bits& b) {
            return Vec3{double(std::bit_cast<float>(b[0])), double(std::bit_cast<float>(b[1])),
                        double(std::bit_cast<float>(b[2]))};
        };
        if (!on_border((place(edge[0]) + place(edge[1])) * 0.5)) ++cracks;
    }
    EXPECT_EQ(cracks, 0u);
    EXPECT_GT(before, 0u) << "blocks without bottoms are open";
    EXPECT_GE(open, before);
}

}  // namespace
}  // namespace exitance
