// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/scene_enclosure.h"

#include <gtest/gtest.h>

#include "exitance/run/error.h"
#include "exitance/scene/formats/view3d.h"
#include "exitance/scene/mend.h"

namespace exitance {
namespace {

Scene scene_of(const std::string& text) {
    Scene scene = parse_view3d("test.vs3", text, {});
    mend(scene);
    return scene;
}

// A floor of 2 × 2 with a hole that another surface fills, a wall in two parts that are combined,
// and something in between.
const std::string room = R"(F 3
V 1 0 0 0
V 2 2 0 0
V 3 2 2 0
V 4 0 2 0
V 5 0.5 0.5 0
V 6 1 0.5 0
V 7 1 1 0
V 8 0.5 1 0
V 9 0 0 2
V 10 0 2 2
V 11 0 1 0
V 12 0 1 2
S 1 1 2 3 4 0 0 0.8 floor
S 2 5 6 7 8 1 0 0.4 plate
S 3 1 11 12 9 0 0 0.6 wall
S 4 11 4 10 12 0 3 0.2 rest
O 5 5 6 7 0 0 0 0.1 thing
End
)";

TEST(SceneEnclosure, HonoursBaseCombineAndObstruction) {
    const Enclosure e = make_enclosure(scene_of(room), {});
    ASSERT_EQ(e.surfaces.size(), 3U);
    EXPECT_EQ(e.surfaces[0].name, "floor");
    EXPECT_EQ(e.surfaces[1].name, "plate");
    EXPECT_EQ(e.surfaces[2].name, "wall");
    EXPECT_NEAR(e.surfaces[0].area, 4 - 0.25, 1e-9) << "the plate is cut out";
    EXPECT_NEAR(e.surfaces[1].area, 0.25, 1e-12);
    EXPECT_NEAR(e.surfaces[2].area, 4, 1e-12) << "both halves";
    EXPECT_NEAR(e.surfaces[0].emissivity, 0.8, 1e-12);
    EXPECT_NEAR(e.surfaces[2].emissivity, 0.4, 1e-12) << "weighted by area";
    std::size_t blocking = 0;
    for (const Facet& facet : e.facets) blocking += facet.row == Facet::only_blocks ? 1 : 0;
    EXPECT_EQ(blocking, 1U);
}

TEST(SceneEnclosure, FacetsAddUpToTheirSurfacesInEveryDivision) {
    const Scene scene = scene_of(room);
    std::size_t patches = 0;
    for (const std::string by : {"polygon", "patch", "element", "surface"}) {
        EnclosureOptions options;
        options.by = by;
        options.patch_size = 0.5;
        const Enclosure e = make_enclosure(scene, options);
        std::vector<double> areas(e.surfaces.size());
        double sum = 0;
        for (const Facet& facet : e.facets) {
            if (facet.row == Facet::only_blocks) continue;
            ASSERT_LT(facet.row, areas.size());
            areas[facet.row] += facet.area;
            sum += facet.area;
            // Counter-clockwise seen from the front, unit normal.
            EXPECT_NEAR(length(facet.normal), 1, 1e-12);
        }
        EXPECT_NEAR(sum, 8, 1e-6) << by;
        for (std::size_t i = 0; i < areas.size(); ++i)
            EXPECT_NEAR(areas[i], e.surfaces[i].area, 1e-9) << by;
        if (by == "patch") patches = e.surfaces.size();
        if (by == "element") {
            EXPECT_EQ(e.surfaces.size(), 4 * patches);
        }
    }
}

TEST(SceneEnclosure, ATwoSidedPolygonHasTwoRowsUnlessBySurface) {
    Scene scene;
    Material paper;
    paper.reflectance = {0.2, 0.3, 0.4};
    paper.exitance = {0, 0, 0};
    paper.two_sided = true;
    const std::uint32_t sheet = scene.add_surface("sheet", scene.add_material(paper));
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}})
        scene.add_point(p);
    Polygon polygon;
    polygon.corners = {0, 1, 2, 3};
    polygon.surface = sheet;
    scene.polygons.push_back(polygon);
    for (const std::string by : {"polygon", "patch"}) {
        EnclosureOptions options;
        options.by = by;
        options.patch_size = 2;
        const Enclosure e = make_enclosure(scene, options);
        ASSERT_EQ(e.surfaces.size(), 2U) << by;
        ASSERT_EQ(e.facets.size(), 2U) << by;
        EXPECT_EQ(e.facets[0].normal, -e.facets[1].normal) << by;
        EXPECT_NEAR(e.surfaces[0].emissivity, 0.7, 1e-12);
        EXPECT_TRUE(e.surfaces[0].name.ends_with(".back") != e.surfaces[1].name.ends_with(".back"))
            << by;
    }
    EnclosureOptions whole;
    whole.by = "surface";
    const Enclosure e = make_enclosure(scene, whole);
    ASSERT_EQ(e.surfaces.size(), 1U);
    EXPECT_NEAR(e.surfaces[0].area, 2, 1e-12);
}

TEST(SceneEnclosure, BentAndNotConvexQuadrilateralsAreSplit) {
    Scene scene;
    Material grey;
    grey.reflectance = {0.5, 0.5, 0.5};
    grey.exitance = {0, 0, 0};
    const std::uint32_t sheet = scene.add_surface("sheet", scene.add_material(grey));
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 1}, Vec3{0, 1, 0},       // bent
                          Vec3{0, 0, 5}, Vec3{2, 0, 5}, Vec3{0.5, 0.5, 5}, Vec3{0, 2, 5}})  // dart
        scene.add_point(p);
    for (const std::uint32_t first : {0U, 4U}) {
        Polygon polygon;
        polygon.corners = {first, first + 1, first + 2, first + 3};
        polygon.surface = sheet;
        scene.polygons.push_back(polygon);
    }
    const Enclosure e = make_enclosure(scene, {});
    ASSERT_EQ(e.surfaces.size(), 2U);
    ASSERT_EQ(e.facets.size(), 4U);
    EXPECT_NEAR(e.surfaces[1].area, 1, 1e-12);
    for (const Facet& facet : e.facets) EXPECT_EQ(facet.count, 3U);
}

TEST(SceneEnclosure, CircularCombinationsAndEmptyScenesAreRefused) {
    const std::string circle =
        "F 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 0 1 0\n"
        "S 1 1 2 3 0 0 2 1 a\nS 2 1 3 2 0 0 1 1 b\nEnd\n";
    EXPECT_THROW(make_enclosure(scene_of(circle), {}), Error);
    EXPECT_THROW(make_enclosure(Scene{}, {}), Error);
}

}  // namespace
}  // namespace exitance
