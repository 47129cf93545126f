// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/exposure.h"

#include <gtest/gtest.h>

#include "exitance/visibility/place_owners.h"
#include "scene/small_scenes.h"

namespace exitance {
namespace {

using exitance::testing::add_polygon;
using exitance::testing::add_square;
using exitance::testing::add_surface;

struct World {
    Scene scene;
    std::uint32_t floor = add_surface(scene, "floor"), block = add_surface(scene, "block");

    /// A block of one-sided walls on [0.3, 0.7]² × [0, 0.4], without a bottom.
    void stand_block() {
        const double a = 0.3, b = 0.7, h = 0.4;
        add_polygon(scene, block, {{a, a, h}, {b, a, h}, {b, b, h}, {a, b, h}});
        add_polygon(scene, block, {{a, a, 0}, {b, a, 0}, {b, a, h}, {a, a, h}});
        add_polygon(scene, block, {{b, a, 0}, {b, b, 0}, {b, b, h}, {b, a, h}});
        add_polygon(scene, block, {{b, b, 0}, {a, b, 0}, {a, b, h}, {b, b, h}});
        add_polygon(scene, block, {{a, b, 0}, {a, a, 0}, {a, a, h}, {a, b, h}});
    }
    RayCaster caster() const {
        std::vector<RayCaster::Face> faces;
        for (const Polygon& p : scene.polygons)
            faces.push_back({p.corners[0], p.corners[1], p.corners[2],
                             p.size() == 4 ? p.corners[3] : p.corners[2]});
        return RayCaster(scene.points, faces);
    }
    bool exposed(const Vec3& point, const Vec3& normal) const {
        const RayCaster c = caster();
        std::vector<char> two_sided;
        for (const Polygon& p : scene.polygons) two_sided.push_back(scene.material(p).two_sided);
        Receivers receivers;  // only the second is asked about
        receivers.add({}, {0, 0, 1}, 0);
        receivers.add(point - c.middle(), normal, 7);
        std::array<char, 1> out{2};
        find_exposed(c, two_sided, receivers, 1, out);
        return out[0];
    }
    bool owns(std::size_t polygon, const Vec3& place, const Vec3& normal) const {
        const RayCaster c = caster();
        const PlaceOwners owners(scene, c);
        const bool back = dot(scene.normal(scene.polygons[polygon]), normal) < 0;
        return owners.owns(PolygonId(polygon), back, place - c.middle());
    }
};

const Vec3 up{0, 0, 1};

TEST(Exposed, OpenFloorAndFloorUnderABlock) {
    World w;
    add_square(w.scene, w.floor, 0, 0, 0);
    w.stand_block();
    EXPECT_TRUE(w.exposed({0.1, 0.1, 0}, up));
    EXPECT_TRUE(w.exposed({0.29, 0.5, 0}, up)) << "beside the block";
    EXPECT_FALSE(w.exposed({0.5, 0.5, 0}, up)) << "under the block";
    EXPECT_FALSE(w.exposed({0.301, 0.301, 0}, up)) << "just under it";
    EXPECT_TRUE(w.exposed({0.5, 0.5, 0.4}, up)) << "on top of it";
}

TEST(Exposed, TheUndersideOfWhatLiesOnAFloorSeesItsFront) {
    // A one-sided floor faces up: a point that looks down onto it from a clearance above is in the
    // dark by occlusion, not buried. From below the floor it is.
    World w;
    add_square(w.scene, w.floor, 0, 0, 0, 10);
    EXPECT_TRUE(w.exposed({5, 5, 1}, {0, 0, -1}));
    EXPECT_FALSE(w.exposed({5, 5, -0.01}, up));
}

TEST(Exposed, TwoSidedWallsDoNotBury) {
    World w;
    add_square(w.scene, w.floor, 0, 0, 0);
    w.stand_block();
    w.scene.materials[1].two_sided = true;
    EXPECT_TRUE(w.exposed({0.5, 0.5, 0}, up)) << "inside a thin-walled box there may be a lamp";
}

TEST(Exposed, NothingAroundIsOpen) {
    World w;
    add_square(w.scene, w.floor, 0, 0, 0);
    EXPECT_TRUE(w.exposed({0.5, 0.5, 0}, up));
}

TEST(PlaceOwnersTest, TheFirstOfCoplanarPolygons) {
    World w;
    add_square(w.scene, w.floor, 0, 0, 0, 4);
    add_square(w.scene, w.block, 1, 1, 0, 1);
    EXPECT_TRUE(w.owns(0, {1.5, 1.5, 0}, up));
    EXPECT_FALSE(w.owns(1, {1.5, 1.5, 0}, up));
    EXPECT_TRUE(w.owns(0, {3, 3, 0}, up));
}

TEST(PlaceOwnersTest, ALampBeforeAllElse) {
    for (const bool lamp_is_first : {false, true}) {
        World w;
        const auto lamp = testing::add_surface(w.scene, "lamp", 0.5, 10);
        if (lamp_is_first) add_square(w.scene, lamp, 1, 1, 0, 1);
        add_square(w.scene, w.floor, 0, 0, 0, 4);
        add_square(w.scene, w.block, 1, 1, 0, 2);
        if (!lamp_is_first) add_square(w.scene, lamp, 1, 1, 0, 1);
        const std::size_t floor = lamp_is_first ? 1 : 0, of_lamp = lamp_is_first ? 0 : 2;
        const Vec3 lit{1.5, 1.5, 0}, beside{2.5, 1.5, 0};
        EXPECT_TRUE(w.owns(of_lamp, lit, up));
        EXPECT_FALSE(w.owns(floor, lit, up));
        EXPECT_FALSE(w.owns(floor + 1, lit, up));
        EXPECT_TRUE(w.owns(floor, beside, up));
        EXPECT_FALSE(w.owns(floor + 1, beside, up)) << "the floor comes first";
        const RayCaster c = w.caster();
        const PlaceOwners owners(w.scene, c);
        const auto below = [&](std::size_t polygon, const Vec3& place) {
            return owners.below_lamp(PolygonId(polygon), false, place - c.middle());
        };
        EXPECT_TRUE(below(floor, lit));
        EXPECT_FALSE(below(floor, beside));
        EXPECT_TRUE(below(floor + 1, lit));
        EXPECT_FALSE(below(floor + 1, beside)) << "what owns that does not emit";
        EXPECT_FALSE(below(of_lamp, lit));
    }
}

TEST(PlaceOwnersTest, NeighboursAndParallelsKeepTheirOwn) {
    World w;
    add_square(w.scene, w.floor, 0, 0, 0);
    add_square(w.scene, w.floor, 1, 0, 0);           // beside it
    add_square(w.scene, w.block, 0, 0, 0.01);        // a centimetre above
    add_square(w.scene, w.block, 0, 0, 0, 1, true);  // the same place, facing down
    EXPECT_TRUE(w.owns(1, {1.5, 0.5, 0}, up));
    EXPECT_TRUE(w.owns(1, {1, 0.5, 0}, up)) << "on the common edge";
    EXPECT_TRUE(w.owns(2, {0.5, 0.5, 0.01}, up));
    EXPECT_TRUE(w.owns(3, {0.5, 0.5, 0}, -up)) << "the other side is not shared";
}

TEST(PlaceOwnersTest, ATwoSidedSheetOnAWallSharesItsSide) {
    World w;
    add_square(w.scene, w.block, 0, 0, 0, 1, true);  // faces down, two-sided
    add_square(w.scene, w.floor, 0, 0, 0);
    EXPECT_TRUE(w.owns(1, {0.5, 0.5, 0}, up));
    w.scene.materials[1].two_sided = true;
    EXPECT_FALSE(w.owns(1, {0.5, 0.5, 0}, up));
}

TEST(PlaceOwnersTest, TrianglesCoverWhatTheyCover) {
    World w;
    add_polygon(w.scene, w.block, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    add_square(w.scene, w.floor, 0, 0, 0);
    EXPECT_FALSE(w.owns(1, {0.2, 0.2, 0}, up));
    EXPECT_TRUE(w.owns(1, {0.8, 0.8, 0}, up));
}

TEST(PlaceOwnersTest, FewPolygonsHaveCovers) {
    World w;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j) add_square(w.scene, w.floor, i, j, 0);
    w.stand_block();
    const PlaceOwners owners(w.scene, w.caster());
    for (std::size_t p = 0; p < w.scene.polygons.size(); ++p)
        EXPECT_TRUE(owners.covers(PolygonId(p), false).empty()) << p;
}

}  // namespace
}  // namespace exitance
