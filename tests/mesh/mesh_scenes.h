// SPDX-License-Identifier: Apache-2.0
// Small closed scenes with different divisions side by side, and random refinement.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "exitance/mesh/mesh.h"
#include "exitance/run/random.h"
#include "exitance/scene/scene.h"
#include "scene/small_scenes.h"

namespace exitance::mesh_scenes {

/// The inside of [0, x] × [0, y] × [0, z]; wall i asks for `patches[i]` patches.
inline Scene box(const Vec3& size, const std::array<std::uint32_t, 6>& patches) {
    const auto [x, y, z] = size;
    Scene scene;
    const auto wall = [&](std::uint32_t k, std::initializer_list<Vec3> corners) {
        const auto surface = testing::add_surface(scene, "wall " + std::to_string(k), 0.5, 1);
        testing::add_polygon(scene, surface, corners).patches = patches[k];
    };
    wall(0, {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}});
    wall(1, {{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}});
    wall(2, {{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}});
    wall(3, {{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}});
    wall(4, {{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}});
    wall(5, {{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}});
    return scene;
}

/// The outside of a unit cube, every side two triangles that ask for different numbers of patches.
inline Scene triangle_cube() {
    Scene scene;
    const auto surface = testing::add_surface(scene, "cube", 0.5, 1);
    const auto corner = [](unsigned i) {
        return Vec3{double(i & 1u), double(i >> 1 & 1u), double(i >> 2 & 1u)};
    };
    const std::array<std::array<unsigned, 4>, 6> sides{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    std::uint32_t patches = 1;
    for (const auto& s : sides) {
        testing::add_polygon(scene, surface, {corner(s[0]), corner(s[1]), corner(s[2])}).patches =
            patches++;
        testing::add_polygon(scene, surface, {corner(s[0]), corner(s[2]), corner(s[3])}).patches =
            patches++;
    }
    return scene;
}

/// An octahedron divided `times` and pushed onto the unit sphere, with the sphere's normals.
inline Scene sphere(int times) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const double x : {1.0, -1.0})
        for (const double y : {1.0, -1.0})
            for (const double z : {1.0, -1.0}) {
                const Vec3 a{x, 0, 0}, b{0, y, 0}, c{0, 0, z};
                if (x * y * z > 0)
                    triangles.push_back({a, b, c});
                else
                    triangles.push_back({a, c, b});
            }
    for (int t = 0; t < times; ++t) {
        std::vector<std::array<Vec3, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const Vec3 ab = normalized(a + b), bc = normalized(b + c), ca = normalized(c + a);
            finer.push_back({a, ab, ca});
            finer.push_back({ab, b, bc});
            finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        triangles = finer;
    }
    Scene scene;
    const auto surface = testing::add_surface(scene, "sphere", 0.5, 1);
    for (const auto& t : triangles) {
        Polygon polygon;
        polygon.surface = surface;
        polygon.patches = 1;
        for (std::size_t i = 0; i < 3; ++i) polygon.corners[i] = scene.add_point(t[i], t[i]);
        scene.polygons.push_back(polygon);
    }
    return scene;
}

/// A two-sided sheet of two squares that are divided differently, and a triangle beside them.
inline Scene two_sided_sheet() {
    Scene scene;
    const auto surface = testing::add_surface(scene, "sheet", 0.5, 1);
    scene.materials[0].two_sided = true;
    testing::add_polygon(scene, surface, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).patches = 6;
    testing::add_polygon(scene, surface, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}).patches = 4;
    testing::add_polygon(scene, surface, {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}}).patches = 9;
    return scene;
}

inline std::vector<ElementId> leaves(const Mesh& mesh) {
    std::vector<ElementId> out;
    for (const Patch& patch : mesh.patches())
        mesh.for_leaves(patch.root, [&](ElementId id) { out.push_back(id); });
    return out;
}

/// Splits `count` leaves. Half of them are leaves of the last split, so that some places get deep.
inline void split_at_random(Mesh& mesh, std::uint64_t seed, int count) {
    std::vector<ElementId> fresh;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t bits = hash_bits(seed, i);
        std::vector<ElementId> from = fresh.empty() || bits % 2 ? leaves(mesh) : fresh;
        const ElementId leaf = from[hash_bits(bits) % from.size()];
        fresh.clear();
        for (const ElementId id : mesh.split(leaf))
            mesh.for_leaves(id, [&](ElementId child) { fresh.push_back(child); });
    }
}

/// Merges wherever allowed, with probability 1/2 each.
inline void merge_at_random(Mesh& mesh, std::uint64_t seed) {
    for (std::size_t e = mesh.elements().size(); e-- > 0;)
        if (hash_bits(seed, e) % 2 && mesh.can_merge(ElementId(e))) {
            // Slots of merged children are no part of the tree.
            bool part = false;
            const Element& element = mesh.elements()[e];
            ElementId up(e);
            while (mesh[up].parent.valid()) {
                const ElementId parent = mesh[up].parent;
                const ElementId first = mesh[parent].first_child;
                if (!first.valid() || up < first || up.index() >= first.index() + 4) break;
                up = parent;
            }
            part = !mesh[up].parent.valid() && mesh[element.patch].root == up;
            if (part) mesh.merge(ElementId(e));
        }
}

}  // namespace exitance::mesh_scenes
