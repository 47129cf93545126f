// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/mesh.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>
#include <set>

#include "exitance/math/polygon.h"
#include "mesh/mesh_scenes.h"

namespace exitance {
namespace {

using namespace mesh_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_square;
using exitance::testing::add_surface;

Mesh mesh_of(const Scene& scene, double patch_size = 10) {
    return Mesh(scene, {patch_size, true});
}

std::size_t patches_of_one(std::initializer_list<Vec3> corners, std::uint32_t patches,
                           MeshOptions options = {10, true}) {
    Scene scene;
    add_polygon(scene, add_surface(scene, "s"), corners).patches = patches;
    return Mesh(scene, options).patches().size();
}

const std::initializer_list<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::initializer_list<Vec3> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(Patches, QuadsHaveAsManyAsTheFileSays) {
    for (const std::uint32_t k : {1u, 2u, 3u, 4u, 7u, 12u, 64u, 97u, 360u})
        EXPECT_EQ(patches_of_one(square, k), k);
}

TEST(Patches, TrianglesHaveTheNextSquareNumber) {
    for (const auto& [asked, made] : std::vector<std::array<std::uint32_t, 2>>{
             {1, 1}, {2, 4}, {4, 4}, {5, 9}, {9, 9}, {10, 16}, {100, 100}, {101, 121}})
        EXPECT_EQ(patches_of_one(triangle, asked), made) << asked;
}

TEST(Patches, AreAsSquareAsTheirNumberAllows) {
    Scene scene;
    add_polygon(scene, add_surface(scene, "s"), {{0, 0, 0}, {6, 0, 0}, {6, 1, 0}, {0, 1, 0}})
        .patches = 24;
    const Mesh mesh = mesh_of(scene);
    EXPECT_EQ(mesh.faces()[0].columns, 12u);
    EXPECT_EQ(mesh.faces()[0].rows, 2u);
}

TEST(Patches, AsManyInARowAsAFileMayAskFor) {
    constexpr std::uint32_t prime = 249'989;  // the largest that scene/formats/limits.h allows
    Scene scene;
    add_polygon(scene, add_surface(scene, "s"), square).patches = prime;
    Mesh mesh = mesh_of(scene);
    ASSERT_EQ(mesh.patches().size(), prime);
    const ElementId last = mesh.patches().back().root;
    EXPECT_GT(mesh[last].u + mesh[last].v, 1 << 29);
    EXPECT_FALSE(mesh.split(last).empty());
    std::vector<Mesh::Between> none;
    mesh.between(mesh[last], 0, std::vector<char>(mesh.positions().size(), 0), none);
    EXPECT_TRUE(none.empty());
}

TEST(Patches, BySizeWhereTheFileDoesNotSay) {
    EXPECT_EQ(patches_of_one(square, 0, {0.5, true}), 4u);
    EXPECT_EQ(patches_of_one(square, 0, {0.49, true}), 9u);
    EXPECT_EQ(patches_of_one(triangle, 0, {0.5, true}), 9u) << "the long side of √2 decides";
    EXPECT_EQ(patches_of_one(square, 7, {0.5, false}), 4u) << "asked not to divide as the file";
}

// The sum of the areas of the leaves of a face against that of its polygon; areas are stored in
// float.
void expect_areas_add_up(const Scene& scene, const Mesh& mesh) {
    std::vector<double> sum(mesh.faces().size(), 0.0);
    for (const ElementId id : leaves(mesh))
        sum[mesh[mesh[id].patch].face.index()] += static_cast<double>(mesh[id].area);
    for (std::size_t f = 0; f < sum.size(); ++f) {
        const double exact = scene.area(scene.polygons[mesh.faces()[f].polygon.index()]);
        EXPECT_NEAR(sum[f], exact, 1e-6 * exact) << "face " << f;
    }
}

// Whether the leaves of every patch tile it: corners of each leaf lie where its coordinates say.
void expect_corners_where_they_belong(const Mesh& mesh) {
    for (const ElementId id : leaves(mesh)) {
        const Element& e = mesh[id];
        const Face& face = mesh.face_of(e);
        const auto corners = mesh.corners(e);
        const std::int32_t s = e.size;
        const std::array<std::array<std::int32_t, 2>, 4> quad{
            {{e.u, e.v}, {e.u + s, e.v}, {e.u + s, e.v + s}, {e.u, e.v + s}}};
        const std::array<std::array<std::int32_t, 2>, 4> three{
            {{e.u, e.v}, {e.u + s, e.v}, {e.u, e.v + s}, {}}};
        const auto& at = e.count == 4 ? quad : three;
        for (std::uint32_t i = 0; i < e.count; ++i)
            EXPECT_EQ(corners[i], mesh.point(face, at[i][0], at[i][1]));
        EXPECT_GT(dot(unit_normal({corners.data(), e.count}), face.normal), 0.999999);
    }
}

std::vector<Scene> all_scenes() {
    Scene odd;  // a general quadrilateral and triangles of no particular shape
    const auto surface = add_surface(odd, "s");
    add_polygon(odd, surface, {{0, 0, 0}, {3, 0.2, 0}, {2.5, 1.7, 0}, {0.3, 1, 0}}).patches = 15;
    add_polygon(odd, surface, {{3, 0.2, 0}, {4, 3, 1}, {2.5, 1.7, 0}}).patches = 3;
    return {box({1, 2, 3}, {1, 2, 3, 4, 5, 7}), triangle_cube(), sphere(1), two_sided_sheet(), odd};
}

TEST(Split, KeepsAreasAndPlaces) {
    for (const Scene& scene : all_scenes()) {
        Mesh mesh = mesh_of(scene);
        expect_areas_add_up(scene, mesh);
        split_at_random(mesh, 5, 150);
        expect_areas_add_up(scene, mesh);
        expect_corners_where_they_belong(mesh);
    }
}

TEST(Split, MakesFourOfOne) {
    for (const auto& corners : {square, triangle}) {
        Scene scene;
        add_polygon(scene, add_surface(scene, "s"), corners);
        Mesh mesh = mesh_of(scene);
        const ElementId root = mesh.patches()[0].root;
        EXPECT_EQ(mesh.split(root), std::vector<ElementId>{root});
        EXPECT_EQ(leaves(mesh).size(), 4u);
        EXPECT_EQ(mesh.vertices().size(), corners.size() == 4 ? 9u : 6u);
        EXPECT_TRUE(mesh.split(root).empty()) << "it is no leaf any more";
    }
}

// Leaves of the same smooth surface that share a whole edge of one of them, with their sizes: a
// leaf whose midpoint of a side has a quarter point as well would have a neighbour two levels
// finer.
void expect_restricted(const Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;  // of leaves, by vertices
    for (const ElementId id : leaves(mesh)) {
        const auto v = mesh[id].corners();
        for (std::size_t i = 0; i < v.size(); ++i) {
            const VertexId a = v[i], b = v[(i + 1) % v.size()];
            edges.insert({std::min(a, b).value, std::max(a, b).value});
        }
    }
    const auto is_edge = [&](VertexId a, VertexId b) {
        return edges.contains({std::min(a, b).value, std::max(a, b).value});
    };
    for (const ElementId id : leaves(mesh)) {
        const Element& e = mesh[id];
        const Face& face = mesh.face_of(e);
        if (e.level + 2 > Mesh::max_level) continue;
        const auto middle = Mesh::midpoints(e);
        const std::int32_t q = e.size / 4;
        const std::array<std::array<std::int32_t, 2>, 4> quad{{{e.u + q, e.v},
                                                               {e.u + 4 * q, e.v + q},
                                                               {e.u + 3 * q, e.v + 4 * q},
                                                               {e.u, e.v + 3 * q}}};
        const std::array<std::array<std::int32_t, 2>, 4> three{
            {{e.u + q, e.v}, {e.u + 3 * q, e.v + q}, {e.u, e.v + 3 * q}, {}}};
        for (std::uint32_t i = 0; i < e.count; ++i) {
            const auto quarter = e.count == 4 ? quad[i] : three[i];
            const auto half_vertex = mesh.find_vertex(face, middle.at[i][0], middle.at[i][1]);
            const auto quarter_vertex = mesh.find_vertex(face, quarter[0], quarter[1]);
            if (!half_vertex || !quarter_vertex) continue;
            EXPECT_FALSE(is_edge(e.vertices[i], *quarter_vertex) &&
                         is_edge(*quarter_vertex, *half_vertex))
                << "side " << i << " of leaf " << id.value << " at level " << int(e.level)
                << " meets leaves two levels finer";
        }
    }
}

// The same division on both sides of every edge, so that the rule reaches across faces.
std::vector<Scene> evenly_divided() {
    Scene floor;
    const auto surface = add_surface(floor, "floor");
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) add_square(floor, surface, i, j, 0).patches = 4;
    add_polygon(floor, surface, {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}}).patches = 4;
    add_polygon(floor, surface, {{4, 0, 0}, {4, 1, 0}, {3, 1, 0}}).patches = 4;
    return {floor, sphere(1), two_sided_sheet()};
}

TEST(Split, KeepsTheQuadtreeRestricted) {
    for (const Scene& scene : evenly_divided())
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            Mesh mesh = mesh_of(scene);
            split_at_random(mesh, seed, 120);
            expect_restricted(mesh);
            merge_at_random(mesh, seed);
            expect_restricted(mesh);
            split_at_random(mesh, seed + 100, 60);
            expect_restricted(mesh);
            expect_areas_add_up(scene, mesh);
        }
}

TEST(Split, GoesAcrossTheFacesOfASmoothSurface) {
    Scene scene;
    const auto surface = add_surface(scene, "floor");
    add_square(scene, surface, 0, 0, 0).patches = 1;
    add_square(scene, surface, 1, 0, 0).patches = 1;
    Mesh mesh = mesh_of(scene);
    ElementId leaf = mesh.patches()[0].root;
    mesh.split(leaf);
    leaf = ElementId(mesh[leaf].first_child.index() + 1);  // (u + h, v): touches the second square
    EXPECT_EQ(mesh.split(leaf).size(), 2u) << "the second square must be split as well";
    EXPECT_FALSE(mesh[mesh.patches()[1].root].leaf());
    expect_restricted(mesh);
}

TEST(Split, StopsAtTheFinestLevel) {
    Scene scene;
    add_square(scene, add_surface(scene, "s"), 0, 0, 0);
    Mesh mesh = mesh_of(scene);
    ElementId leaf = mesh.patches()[0].root;
    for (int level = 0; level < Mesh::max_level; ++level) {
        EXPECT_FALSE(mesh.split(leaf).empty());
        leaf = ElementId(mesh[leaf].first_child.index() + 2);
    }
    EXPECT_EQ(mesh[leaf].level, Mesh::max_level);
    EXPECT_EQ(mesh[leaf].size, 1);
    const std::size_t before = mesh.elements().size();
    EXPECT_TRUE(mesh.split(leaf).empty());
    EXPECT_EQ(mesh.elements().size(), before);
    expect_restricted(mesh);
    expect_areas_add_up(scene, mesh);
}

TEST(Merge, UndoesSplits) {
    for (const Scene& scene : all_scenes()) {
        Mesh mesh = mesh_of(scene);
        const std::vector<ElementId> roots = leaves(mesh);
        split_at_random(mesh, 9, 80);
        for (int level = Mesh::max_level; level >= 0; --level)
            for (std::size_t e = 0; e < mesh.elements().size(); ++e) {
                const Element& element = mesh.elements()[e];
                if (element.leaf() || element.level != level) continue;
                ASSERT_TRUE(mesh.can_merge(ElementId(e))) << "finest first, nothing is in the way";
                mesh.merge(ElementId(e));
            }
        EXPECT_EQ(leaves(mesh), roots);
        expect_areas_add_up(scene, mesh);
        // And the mesh still works: split again, in the slots that are free.
        const std::size_t slots = mesh.elements().size();
        mesh.split(roots[0]);
        EXPECT_EQ(mesh.elements().size(), slots);
        expect_corners_where_they_belong(mesh);
    }
}

TEST(Merge, IsRefusedBesideFinerLeaves) {
    Scene scene;
    add_square(scene, add_surface(scene, "s"), 0, 0, 0);
    Mesh mesh = mesh_of(scene);
    const ElementId root = mesh.patches()[0].root;
    EXPECT_FALSE(mesh.can_merge(root)) << "a leaf has nothing to merge";
    mesh.split(root);
    EXPECT_TRUE(mesh.can_merge(root));
    const ElementId a = mesh[root].first_child, b(a.index() + 1);
    mesh.split(a);
    EXPECT_FALSE(mesh.can_merge(root)) << "its children are not all leaves";
    mesh.split(b);
    EXPECT_TRUE(mesh.can_merge(b));
    mesh.split(mesh[a].first_child.index() ? ElementId(mesh[a].first_child.index() + 1) : a);
    EXPECT_FALSE(mesh.can_merge(b)) << "a's child beside it is finer by two then";
}

using Bits = std::array<std::uint64_t, 3>;
Bits bits_of(const Vec3& p) {
    return {std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
            std::bit_cast<std::uint64_t>(p.z)};
}

TEST(Positions, OfSharedEdgesAgreeBitForBit) {
    // Two rectangles with a long common edge in no special direction, divided 4 and 3 times along
    // it: eighths, twelfths and so on of both must be the same doubles where they mean the same.
    Scene scene;
    const Vec3 a{0.1, 0.7, -0.3}, b{2.3, 1.9, 1.1};
    const Vec3 side = cross(b - a, {0.3, -1, 0.2});
    add_polygon(scene, add_surface(scene, "one"), {a, b, b + side * 1e-3, a + side * 1e-3})
        .patches = 4;
    add_polygon(scene, add_surface(scene, "two"), {b, a, a - side * 1e-3, b - side * 1e-3})
        .patches = 3;
    Mesh mesh = mesh_of(scene);
    for (int round = 0; round < 3; ++round)
        for (const ElementId leaf : leaves(mesh)) mesh.split(leaf);
    const auto on_edge = [&](std::uint32_t face) {
        std::map<Bits, PositionId> out;
        for (const ElementId id : leaves(mesh))
            for (const VertexId v : mesh[id].corners()) {
                const Vec3& p = mesh[mesh[v].position];
                if (mesh[mesh[id].patch].face.value == face &&
                    length(cross(p - a, b - a)) < 1e-12 * dot(b - a, b - a))
                    out[bits_of(p)] = mesh[v].position;
            }
        return out;
    };
    const auto one = on_edge(0), two = on_edge(1);
    std::size_t shared = 0;
    for (const auto& [bits, position] : one) {
        const auto other = two.find(bits);
        if (other == two.end()) continue;
        EXPECT_EQ(other->second, position) << "one place, one id";
        ++shared;
    }
    // With n and m divisions of the edge, gcd(n, m) + 1 places are common.
    EXPECT_EQ(shared, std::gcd(one.size() - 1, two.size() - 1) + 1);
    EXPECT_NE(one.size(), two.size());
    // No two places of both lie nearer than 1e-9 without being the same.
    std::vector<double> along;
    for (const auto* places : {&one, &two})
        for (const auto& [bits, position] : *places)
            if (places == &one || !one.contains(bits))
                along.push_back(dot(mesh[position] - a, b - a) / dot(b - a, b - a));
    std::sort(along.begin(), along.end());
    for (std::size_t i = 1; i < along.size(); ++i) EXPECT_GT(along[i] - along[i - 1], 1e-3);
}

TEST(Positions, AreSharedByBothSidesOfATwoSidedFace) {
    Scene scene = two_sided_sheet();
    Mesh mesh = mesh_of(scene);
    ASSERT_EQ(mesh.faces().size(), 6u);
    for (int round = 0; round < 2; ++round)
        for (const ElementId leaf : leaves(mesh)) mesh.split(leaf);
    std::array<std::set<std::uint32_t>, 2> places, vertices;
    for (const ElementId id : leaves(mesh))
        for (const VertexId v : mesh[id].corners()) {
            const bool back = mesh.face_of(mesh[id]).back;
            places[back].insert(mesh[v].position.value);
            vertices[back].insert(v.value);
            EXPECT_LT(double(mesh[v].normal.z) * (back ? 1 : -1), -0.999);
        }
    EXPECT_EQ(places[0], places[1]);
    EXPECT_EQ(vertices[0].size(), vertices[1].size());
    for (const std::uint32_t v : vertices[0])
        EXPECT_FALSE(vertices[1].contains(v)) << "each side has its own light";
}

TEST(Weld, JoinsWhatRoundingSeparated) {
    Scene scene;
    const auto surface = add_surface(scene, "s");
    add_square(scene, surface, 0, 0, 0, 100);
    add_polygon(scene, surface,
                {{100 + 1e-6, 0, 0}, {200, 0, 0}, {200, 100, -1e-6}, {100, 100 - 1e-6, 1e-6}});
    EXPECT_EQ(mesh_of(scene, 1000).positions().size(), 6u);
}

TEST(Weld, KeepsApartWhatIsApart) {
    Scene scene;
    const auto surface = add_surface(scene, "s");
    add_square(scene, surface, 0, 0, 0, 100);
    add_square(scene, surface, 0, 0, 1e-3, 100);  // a poster a millimetre off a wall
    EXPECT_EQ(mesh_of(scene, 1000).positions().size(), 8u);
}

TEST(Weld, NegativeZeroIsZero) {
    Scene scene;
    const auto surface = add_surface(scene, "s");
    add_polygon(scene, surface, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    add_polygon(scene, surface, {{-0.0, -0.0, 0}, {0, 1, -0.0}, {-1, 0, 0}});
    EXPECT_EQ(mesh_of(scene).positions().size(), 4u);
}

TEST(Weld, DegeneratePolygonsHaveNoFace) {
    Scene scene;
    const auto surface = add_surface(scene, "s");
    add_square(scene, surface, 0, 0, 0);
    add_polygon(scene, surface, {{0, 0, 0}, {1, 0, 0}, {1 + 1e-9, 1e-9, 0}});
    EXPECT_EQ(mesh_of(scene).faces().size(), 1u);
}

TEST(Smooth, CoplanarTrianglesOfOneSurfaceShareVertices) {
    Scene scene;
    const auto surface = add_surface(scene, "s");
    add_polygon(scene, surface, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    add_polygon(scene, surface, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const Mesh mesh = mesh_of(scene);
    EXPECT_EQ(mesh.vertices().size(), 4u);
    EXPECT_EQ(mesh.faces()[0].smooth, mesh.faces()[1].smooth);
}

TEST(Smooth, DifferentMaterialsDoNotShareVertices) {
    Scene scene;
    add_polygon(scene, add_surface(scene, "s"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    add_polygon(scene, add_surface(scene, "t"), {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const Mesh mesh = mesh_of(scene);
    EXPECT_EQ(mesh.positions().size(), 4u);
    EXPECT_EQ(mesh.vertices().size(), 6u);
}

TEST(Smooth, AFoldIsAnEdgeUnlessTheNormalsSayOtherwise) {
    const auto vertices = [](bool rounded) {
        Scene scene;
        const auto surface = add_surface(scene, "s");
        const Vec3 n = rounded ? normalized(Vec3{0, -0.2, 1}) : Vec3{};
        const auto a = scene.add_point({0, 0, 0}, n), b = scene.add_point({1, 0, 0}, n);
        scene.polygons.push_back({{a, b, scene.add_point({0, 1, 0}), Polygon::none}, surface});
        scene.polygons.push_back({{b, a, scene.add_point({0, -1, -0.4}), Polygon::none}, surface});
        return mesh_of(scene).vertices().size();
    };
    EXPECT_EQ(vertices(false), 6u);
    EXPECT_EQ(vertices(true), 4u);
}

TEST(Sample, StandsInsideTheFaceAtItsBorder) {
    Scene scene;
    add_square(scene, add_surface(scene, "s"), 0, 0, 0).patches = 16;
    const Mesh mesh = mesh_of(scene);
    for (const Vertex& v : mesh.vertices()) {
        const Vec3 p = mesh[v.position], s = v.sample;
        EXPECT_TRUE(s.x > 0 && s.x < 1 && s.y > 0 && s.y < 1) << s.x << " " << s.y;
        const bool border = p.x == 0 || p.x == 1 || p.y == 0 || p.y == 1;
        EXPECT_LE(length(s - p), border ? 1e-3 : 0.0);
    }
}

}  // namespace
}  // namespace exitance
