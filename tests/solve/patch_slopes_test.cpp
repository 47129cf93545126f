// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/patch_slopes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/math/polygon.h"
#include "scene/small_scenes.h"

namespace exitance {
namespace {

// A floor of 2 m × 1 m and, to its right, a triangle of the same plane and material.
Mesh floor_and_triangle() {
    static Scene scene;
    scene = Scene();
    const auto s = testing::add_surface(scene, "floor", 0.5);
    testing::add_polygon(scene, s, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
    testing::add_polygon(scene, s, {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}});
    return Mesh(scene, MeshOptions::of_patches(0.25));
}

struct Patches {
    RowField values;
    std::vector<float> area;
};

// What 3 + 0.5 x - 2 y is in the middle of each patch, and 0 more columns.
Patches rising(const Mesh& mesh) {
    const std::size_t n = mesh.patches().size();
    Patches out{RowField(n, 1), std::vector<float>(n, 1.0f)};
    for (std::size_t p = 0; p < n; ++p) {
        const Element& root = mesh[mesh.patches()[p].root];
        const auto corners = mesh.corners(root);
        const Vec3 middle = centroid({corners.data(), root.count});
        out.values[RowId(p)][0] = static_cast<float>(3 + 0.5 * middle.x - 2 * middle.y);
    }
    return out;
}

TEST(PatchSlopes, WhatIsLinearStaysSoWithinEveryPatch) {
    const Mesh mesh = floor_and_triangle();
    const Patches patches = rising(mesh);
    const PatchSlopes slopes(mesh, patches.area);
    std::size_t exact = 0;
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        const auto corners = mesh.corners(mesh[mesh.patches()[p].root]);
        const std::size_t count = mesh[mesh.patches()[p].root].count;
        std::vector<float> s(patches.values.stride()), t(patches.values.stride());
        slopes.find(PatchId(p), patches.values, s, t);
        const Vec3 a = corners[1] - corners[0], b = corners[count - 1] - corners[0];
        // In the three corners of the triangle, whose patches are smaller than the floor's, one
        // neighbour says nothing of the other direction.
        if (std::abs(s[0] - (0.5 * a.x - 2 * a.y)) < 2e-3 &&
            std::abs(t[0] - (0.5 * b.x - 2 * b.y)) < 2e-3) {
            ++exact;
            continue;
        }
        EXPECT_EQ(count, 3) << "patch " << p;
    }
    EXPECT_EQ(exact + 3, mesh.patches().size());
}

TEST(PatchSlopes, SliversAndTwinsHaveFiniteOnes) {
    Scene scene;
    const auto s = testing::add_surface(scene, "wall", 0.5);
    testing::add_polygon(scene, s, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    testing::add_polygon(scene, s, {{0, 1, 0}, {1, 1, 0}, {0.5, 1.000001, 0}});
    testing::add_polygon(scene, s, {{1, 0, 0}, {1.000001, 0.3, 0}, {1, 1, 0}});
    testing::add_polygon(scene, s, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});  // once more
    const Mesh mesh(scene, MeshOptions::of_patches(1));
    const Patches patches = rising(mesh);
    const PatchSlopes slopes(mesh, patches.area);
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        std::vector<float> along_s(patches.values.stride()), along_t(patches.values.stride());
        slopes.find(PatchId(p), patches.values, along_s, along_t);
        EXPECT_TRUE(std::isfinite(along_s[0]) && std::isfinite(along_t[0])) << "patch " << p;
    }
}

TEST(PatchSlopes, WhatIsBuriedTellsNothing) {
    const Mesh mesh = floor_and_triangle();
    Patches patches = rising(mesh);
    std::fill(patches.area.begin(), patches.area.end(), 0.0f);
    patches.area[0] = 1;
    const PatchSlopes slopes(mesh, patches.area);
    std::vector<float> s(patches.values.stride()), t(patches.values.stride());
    slopes.find(PatchId(0), patches.values, s, t);
    EXPECT_EQ(s[0], 0);
    EXPECT_EQ(t[0], 0);
}

TEST(PatchSlopes, NothingBecomesNegative) {
    const Mesh mesh = floor_and_triangle();
    Patches patches = rising(mesh);
    for (std::size_t p = 0; p < mesh.patches().size(); ++p)
        patches.values[RowId(p)][0] = p % 3 == 0 ? 0.01f : 5.0f;
    const PatchSlopes slopes(mesh, patches.area);
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        std::vector<float> s(patches.values.stride()), t(patches.values.stride());
        slopes.find(PatchId(p), patches.values, s, t);
        const float middle = mesh[mesh.patches()[p].root].count == 3 ? 1.0f / 3 : 0.5f;
        for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}})
            EXPECT_GE(patches.values[RowId(p)][0] + (x - middle) * s[0] + (y - middle) * t[0],
                      -1e-6f);
    }
}

}  // namespace
}  // namespace exitance
