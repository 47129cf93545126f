// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/cut.h"

#include <gtest/gtest.h>

#include "exitance/math/polygon.h"
#include "mesh/mesh_scenes.h"

namespace exitance {
namespace {

using namespace mesh_scenes;
using exitance::testing::add_polygon;
using exitance::testing::add_surface;

constexpr double snap = 1e-6;
const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

std::vector<Vec3> corners_of(const CutPolygon& polygon, const Piece& piece) {
    std::vector<Vec3> out;
    for (std::uint32_t i = 0; i < piece.count; ++i) out.push_back(polygon.places[piece.corners[i]]);
    return out;
}

// Pieces tile the polygon, are convex, and their sides lie where they say.
void expect_tiles(const std::vector<Vec3>& corners, const CutPolygon& polygon) {
    double sum = 0;
    for (const Piece& piece : polygon.pieces) {
        const std::vector<Vec3> p = corners_of(polygon, piece);
        sum += vector_area(p).z;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 &a = p[i], &b = p[(i + 1) % p.size()], &c = p[(i + 2) % p.size()];
            EXPECT_GT(cross(b - a, c - b).z, 0);
            const CutLine& line = polygon.lines[piece.sides[i].line];
            const Vec3 from = polygon.places[line.from], to = polygon.places[line.to];
            EXPECT_LT(length(from + (to - from) * piece.sides[i].begin - a), 3 * snap);
            EXPECT_LT(length(from + (to - from) * piece.sides[i].end - b), 3 * snap);
        }
    }
    EXPECT_NEAR(sum, vector_area(corners).z, 1e-9);
}

TEST(Cut, AWallAcrossMakesTwoRooms) {
    const std::vector<Contact> contacts{{{0.25, 0, 0}, {0.25, 1, 0}, 0}};
    const CutPolygon cut_square = cut(square, contacts, snap);
    expect_tiles(square, cut_square);
    ASSERT_EQ(cut_square.pieces.size(), 2u);
    ASSERT_EQ(cut_square.lines.size(), 5u);
    const CutLine& seam = cut_square.lines[4];
    ASSERT_EQ(seam.contacts.size(), 1u);
    EXPECT_EQ(seam.contacts[0].begin, 0);
    EXPECT_EQ(seam.contacts[0].end, 1);
    EXPECT_FALSE(seam.contacts[0].open_begin || seam.contacts[0].open_end);
    EXPECT_EQ(cut_square.lines[0].marks.size(), 1u);
}

TEST(Cut, AWallThatEndsIsOpenThere) {
    const std::vector<Contact> contacts{{{0.5, 0, 0}, {0.5, 0.4, 0}, 0}};
    const CutPolygon cut_square = cut(square, contacts, snap);
    ASSERT_EQ(cut_square.pieces.size(), 2u);
    CutLine::Contacted c = cut_square.lines[4].contacts.at(0);
    if (cut_square.places[cut_square.lines[4].from].y > 0.5) {
        c = {1 - c.end, 1 - c.begin, c.open_end, c.open_begin, 0};
    }
    EXPECT_NEAR(c.begin, 0, 1e-12);
    EXPECT_NEAR(c.end, 0.4, 1e-12);
    EXPECT_FALSE(c.open_begin);
    EXPECT_TRUE(c.open_end);
}

TEST(Cut, AWallOnTheBorderCutsNothing) {
    const std::vector<Contact> contacts{{{0, 0, 0}, {0.6, 0, 0}, 3}};
    const CutPolygon cut_square = cut(square, contacts, snap);
    EXPECT_EQ(cut_square.pieces.size(), 1u);
    ASSERT_EQ(cut_square.lines[0].contacts.size(), 1u);
    EXPECT_EQ(cut_square.lines[0].contacts[0].polygon, 3u);
}

TEST(Cut, ThroughCornersAndNearThem) {
    for (const double off : {0.0, 0.5e-6, -0.5e-6, 3e-6}) {
        const std::vector<Contact> contacts{{{off, 0, 0}, {1, 1 - off, 0}, 0},
                                            {{0, 1, 0}, {1 - off, off, 0}, 0}};
        expect_tiles(square, cut(square, contacts, snap));
    }
}

TEST(Cut, AnyLinesOnAnyPolygonTileIt) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        auto random = [&, n = 0u]() mutable { return uniform(seed, n++); };
        std::vector<Vec3> corners = square;
        if (seed % 2) corners.pop_back();
        for (Vec3& c : corners) c += Vec3{0.3 * random(), 0.3 * random(), 0};
        std::vector<Contact> contacts;
        for (std::uint64_t k = 0; k < 1 + seed % 12; ++k) {
            Vec3 from{random(), random(), 0}, to{random(), random(), 0};
            if (k % 3 == 1) from.x = to.x = std::floor(from.x * 4) / 4;
            if (k % 3 == 2) from = contacts.back().to;
            contacts.push_back({from, to, 0});
        }
        expect_tiles(corners, cut(corners, contacts, snap));
    }
}

// A wall from the floor to the ceiling, of two pieces that meet at a right angle.
Scene parted_box() {
    Scene scene = box({1, 2, 3}, {1, 2, 3, 4, 5, 7});
    const auto wall = add_surface(scene, "partition", 0.5);
    scene.materials.back().two_sided = true;
    add_polygon(scene, wall, {{0.4, 0, 0}, {0.4, 0.7, 0}, {0.4, 0.7, 3}, {0.4, 0, 3}});
    add_polygon(scene, wall, {{0.4, 0.7, 0}, {1, 0.7, 0}, {1, 0.7, 3}, {0.4, 0.7, 3}});
    return scene;
}

Mesh mesh_of(const Scene& scene) {
    MeshOptions options;
    options.patch_size = 10;
    return Mesh(scene, options);
}

TEST(Contacts, PartTheLightOfTwoRooms) {
    const Mesh mesh = mesh_of(parted_box());
    // Where the partition stands, the floor has a vertex for either room and each is inside it.
    std::size_t feet = 0;
    for (const Vertex& v : mesh.vertices()) {
        const Vec3 p = mesh[v.position];
        if (mesh[v.face].polygon.value != 0 || std::abs(p.x - 0.4) > 1e-9 || p.y > 0.7) continue;
        ++feet;
        EXPECT_NE(v.sample.x, 0.4);
    }
    EXPECT_GE(feet, 4u) << "two ends, two rooms";
}

TEST(Contacts, AreNoneOfASmoothSurfaceWithItself) {
    const Scene scene = sphere(1);
    EXPECT_EQ(mesh_of(scene).vertices().size(), 18u) << "one per corner";
}

TEST(Contacts, OfATableLegAreTooShort) {
    Scene scene = box({1, 1, 1}, {1, 1, 1, 1, 1, 1});
    const auto leg = add_surface(scene, "leg", 0.5);
    add_polygon(scene, leg, {{0.5, 0.5, 0}, {0.55, 0.5, 0}, {0.55, 0.5, 0.7}, {0.5, 0.5, 0.7}});
    EXPECT_EQ(find_contacts(scene, 0.1, 1e-6)[0].size(), 4u) << "the walls alone";
    EXPECT_EQ(find_contacts(scene, 0.02, 1e-6)[0].size(), 5u);
}

TEST(Contacts, OfAWallThatPassesThroughAFloor) {
    Scene scene;
    const auto s = add_surface(scene, "s", 0.5);
    add_polygon(scene, s, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_polygon(scene, s, {{-1, 0.5, -0.1}, {2, 0.5, -0.1}, {2, 0.5, 1}, {-1, 0.5, 1}});
    const auto contacts = find_contacts(scene, 0.1, 1e-6);
    ASSERT_EQ(contacts[0].size(), 1u);
    EXPECT_NEAR(length(contacts[0][0].to - contacts[0][0].from), 1, 1e-12);
    ASSERT_EQ(contacts[1].size(), 1u) << "the floor passes through the wall as well";
}

}  // namespace
}  // namespace exitance
