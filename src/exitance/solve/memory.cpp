// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "exitance/run/error.h"

namespace exitance {

namespace {

// The program, its libraries and threads; what the allocator cannot use.
constexpr double program = 32e6, unused = 1.1;
// A quad in one of Embree's trees: its corners, its place and what a tree of them takes (measured).
constexpr double tree_bytes = 150;
// A polygon as it was read; its sides with their edges while the mesh is made; what a patch adds.
constexpr double polygon_bytes = 120, face_bytes = 1000, patch_bytes = 400;
// A patch as a row with its neighbours; while the balance is struck, its lists of hits and its
// fields, too.
constexpr double row_bytes = 80, balance_bytes = 250, balance_fields = 5;
// Whom a ray of a patch met: listed by either patch, added up, and in a matrix from both sides.
constexpr double hit_bytes = 20;
constexpr std::uint32_t fewest_patch_rays = 16;
// What is reflected, in cells (reflected_light.cpp).
constexpr double cells_of_patch = 64, most_cells = 256 << 20;
// Three bytes, and six for each of the smaller copies, a third as many.
constexpr double bytes_per_texel = 5;
// Elements of a quadtree per vertex, of quads and of triangles; triangles of a solution per vertex
// of the mesh; its vertices for each, which it also has where meshes meet.
constexpr double elements_of_quads = 1.7, elements_of_triangles = 2.8;
constexpr double triangles_per_vertex = 2.4, solution_vertices = 1.35;

double texture_bytes(const Scene& scene) {
    double out = 0;
    std::set<const Texture*> seen;
    for (const Material& material : scene.materials)
        for (const Pattern* pattern : {&material.reflectance_pattern, &material.exitance_pattern})
            if (*pattern && seen.insert(pattern->texture.get()).second)
                out += bytes_per_texel * double(pattern->texture->picture().rgb.size() / 3);
    return out;
}

// A hash table whose size is a power of two and that is half full at most.
double table_bytes(double entries, double bucket) {
    return bucket * std::exp2(std::ceil(std::log2(std::max(2 * entries, 16.0))));
}

[[noreturn]] void refuse(double needed, double limit) {
    throw Error(Fault::could_not_finish,
                fmt::format("--memory {:.0f} MB: this scene needs at least about {:.0f} MB",
                            limit / 1e6, std::ceil(needed / 1e6)));
}

}  // namespace

void require_memory(const Scene& scene, double patch_size, double limit) {
    double faces = 0;
    for (const Polygon& polygon : scene.polygons)
        faces += scene.material(polygon).two_sided ? 2 : 1;
    const double patches = std::max(faces, scene.area() / (patch_size * patch_size));
    const double needed = program + texture_bytes(scene) +
                          (polygon_bytes + tree_bytes) * double(scene.polygons.size()) +
                          face_bytes * faces + (tree_bytes + row_bytes + patch_bytes) * patches;
    if (needed > limit) refuse(needed, limit);
}

MemoryPlan::MemoryPlan(const Radiosity& radiosity, double limit, double besides)
    : limit_(limit),
      begin_vertices_(double(radiosity.mesh.vertices().size())),
      patches_(double(radiosity.mesh.patches().size())),
      stride_(double(radiosity.columns.stride) * sizeof(float)),
      triangular_(0) {
    for (const Patch& patch : radiosity.mesh.patches())
        if (radiosity.mesh[patch.root].count == 3) ++triangular_;
    triangular_ /= std::max(patches_, 1.0);
    fixed_ = program + texture_bytes(radiosity.scene) + besides + double(radiosity.bytes()) +
             (polygon_bytes + tree_bytes) * double(radiosity.scene.polygons.size()) +
             (tree_bytes + row_bytes + stride_) * patches_;
    // A cell for each patch at least.
    const double least =
        std::max(need(begin_vertices_), need_of_balance(begin_vertices_, fewest_patch_rays)) +
        unused * 2 * stride_ * patches_;
    if (least > limit_) refuse(least, limit_);
    const double room = (limit_ - least) / unused;
    const double cells =
        std::min(most_cells, cells_of_patch * (1 + triangular_) * stride_ * patches_);
    const double share = 2 * stride_ * patches_ + 0.25 * room;
    most_cell_bytes_ = static_cast<std::size_t>(cells <= share ? most_cells : share);
    fixed_ += std::min(cells, share);
    double low = begin_vertices_, high = 4e9;
    while (high - low > 1) {
        const double middle = std::floor(0.5 * (low + high));
        const bool fits =
            need(middle) <= limit_ && need_of_balance(middle, fewest_patch_rays) <= limit_;
        (fits ? low : high) = middle;
    }
    most_vertices_ = static_cast<std::size_t>(low);
    most_vertices_of_direct_ =
        static_cast<std::size_t>(begin_vertices_ + 0.9 * (low - begin_vertices_));
}

// The mesh beyond the undivided patches, and what is known of all its vertices.
double MemoryPlan::mesh_bytes(double vertices) const {
    const double elements =
        elements_of_quads + triangular_ * (elements_of_triangles - elements_of_quads);
    const double more = std::max(0.0, vertices - begin_vertices_);
    const auto grown = [&](double per_vertex, double bucket) {
        return table_bytes(per_vertex * vertices, bucket) -
               table_bytes(per_vertex * begin_vertices_, bucket);
    };
    const double mesh = more * (110 + stride_ + elements * (48 + stride_)) +
                        (more > 0 ? 2 * grown(1, 32) + grown(1.4 * elements, 32) : 0);
    const double gathering = vertices * (20 + 2 * stride_ + elements * (8 + 0.3 * stride_));
    return mesh + gathering;
}

// When held-out points look at a solution: it is there beside the mesh, with a tree of its own, and
// beside the best one so far.
double MemoryPlan::need(double vertices) const {
    const double solution = vertices * (solution_vertices * (48 + 2 * stride_) +
                                        triangles_per_vertex * (40 + tree_bytes));
    const double kept = vertices * (solution_vertices * (24 + stride_) + triangles_per_vertex * 12);
    return unused * (fixed_ + mesh_bytes(vertices) + solution + kept);
}

// There is no solution yet to look at.
double MemoryPlan::need_of_balance(double vertices, double rays) const {
    return unused * (fixed_ + mesh_bytes(vertices) +
                     (balance_bytes + balance_fields * stride_ + hit_bytes * rays) * patches_);
}

std::uint32_t MemoryPlan::patch_rays(std::uint32_t wanted, std::size_t vertices) const {
    std::uint32_t rays = std::bit_ceil(wanted);
    while (rays > fewest_patch_rays && need_of_balance(double(vertices), rays) > limit_) rays /= 2;
    return std::min(wanted, rays);
}

}  // namespace exitance
