// SPDX-License-Identifier: Apache-2.0
// From polygons to faces and patches: weld, take sides, join what is smooth, divide.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/math/polygon.h"
#include "exitance/mesh/mesh.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Corners closer than this share of the scene's diagonal are one place: what transforms in float
// leave of coordinates that were meant to be equal.
constexpr double weld_tolerance = 1e-7;

// Coplanar: normals within a quarter of a degree.
constexpr double coplanar_cosine = 0.99999;
// Shading normals that a file gives to both sides of an edge are the same within a degree.
constexpr double smooth_cosine = 0.9998;

std::uint64_t bits_of(std::uint32_t high, std::uint32_t low) {
    return std::uint64_t{high} << 32 | low;
}

struct ExactHash {
    std::size_t operator()(const Vec3& p) const {
        // + 0.0 makes the two zeros equal.
        return hash_bits(std::bit_cast<std::uint64_t>(p.x + 0.0),
                         std::bit_cast<std::uint64_t>(p.y + 0.0),
                         std::bit_cast<std::uint64_t>(p.z + 0.0));
    }
};

// Disjoint sets with path halving.
struct Sets {
    std::vector<std::uint32_t> parent;

    explicit Sets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    // The smaller number becomes the root, so the outcome does not depend on the order of joins.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent[std::max(a, b)] = std::min(a, b);
    }
};

// Two factors of `patches` whose ratio is nearest to width : height.
std::array<std::uint32_t, 2> divide_exactly(std::uint32_t patches, double width, double height) {
    std::array<std::uint32_t, 2> best{patches, 1};
    double best_misfit = INFINITY;
    for (std::uint32_t columns = 1; columns <= patches; ++columns) {
        if (patches % columns) continue;
        const std::uint32_t rows = patches / columns;
        const double misfit = std::abs(std::log((width / columns) / (height / rows)));
        if (misfit < best_misfit) best_misfit = misfit, best = {columns, rows};
    }
    return best;
}

std::uint32_t divide_by_size(double length, double size) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(length / size - 1e-6), 1.0, 4096.0));
}

}  // namespace

Mesh::Mesh(const Scene& scene, const MeshOptions& options) {
    weld(scene);
    make_faces(scene, options);
    join_smooth(scene);
    make_patches();
}

void Mesh::weld(const Scene& scene) {
    const Box bounds = scene.bounds();
    const double cell = std::max(bounds.diagonal() * weld_tolerance, 1e-300);
    const auto cell_of = [&](const Vec3& p, int dx, int dy, int dz) {
        const auto coordinate = [&](double x, double low, int d) {
            return static_cast<std::uint64_t>(
                       static_cast<std::int64_t>(std::floor((x - low) / cell)) + d + 1) &
                   0xffffffffULL;
        };
        return Key{coordinate(p.x, bounds.lower.x, dx) << 32 | coordinate(p.y, bounds.lower.y, dy),
                   coordinate(p.z, bounds.lower.z, dz)};
    };
    std::vector<char> used(scene.points.size(), 0);
    for (const Polygon& polygon : scene.polygons)
        for (const std::uint32_t i : polygon.indices()) used[i] = 1;

    tsl::robin_map<Vec3, PositionId, ExactHash> exact;
    Table<PositionId> cells;
    position_of_point_.resize(scene.points.size());
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        if (!used[i]) continue;
        const Vec3& p = scene.points[i];
        const auto [same, fresh] = exact.insert({p, PositionId(positions_.size())});
        PositionId match = fresh ? PositionId{} : same->second;
        for (int n = 0; n < 27 && !match.valid(); ++n) {
            // The middle cell first: most duplicates are exact.
            const int m = (n + 13) % 27;
            const auto found = cells.find(cell_of(p, m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1));
            if (found != cells.end() && length(positions_[found->second.index()] - p) < cell)
                match = found->second;
        }
        if (!match.valid()) {
            match = PositionId(positions_.size());
            positions_.push_back(p);
            cells.insert({cell_of(p, 0, 0, 0), match});
        }
        same.value() = match;
        position_of_point_[i] = match;
    }
}

void Mesh::make_faces(const Scene& scene, const MeshOptions& options) {
    Table<std::uint32_t> edge_of;
    for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
        const Polygon& polygon = scene.polygons[p];
        const std::uint32_t n = polygon.size();
        Face face;
        face.polygon = PolygonId(p);
        face.surface = polygon.surface;
        face.count = n;
        std::array<Vec3, 4> at;
        for (std::uint32_t i = 0; i < n; ++i) {
            face.corners[i] = position_of_point_[polygon.corners[i]];
            at[i] = positions_[face.corners[i].index()];
            face.normals[i] = scene.normals[polygon.corners[i]];
        }
        const std::span corners(at.data(), n);
        // Degenerate after welding: it has no light of its own (still blocks rays, harmlessly).
        bool degenerate = area(corners) <= 0;
        for (std::uint32_t i = 0; i < n; ++i)
            degenerate |= face.corners[i] == face.corners[(i + 1) % n];
        if (degenerate) continue;
        face.normal = unit_normal(corners);

        const double width = std::max(length(at[1] - at[0]), n == 4 ? length(at[2] - at[3]) : 0.0);
        const double height = n == 4 ? std::max(length(at[2] - at[1]), length(at[3] - at[0]))
                                     : std::max(length(at[2] - at[1]), length(at[2] - at[0]));
        const bool as_file = options.divide_as_file && polygon.patches > 0;
        if (n == 3) {
            face.columns = as_file ? static_cast<std::uint32_t>(std::ceil(
                                         std::sqrt(static_cast<double>(polygon.patches)) - 1e-9))
                                   : divide_by_size(std::max(width, height), options.patch_size);
            face.rows = face.columns;
        } else if (as_file) {
            const auto [columns, rows] = divide_exactly(polygon.patches, width, height);
            face.columns = columns, face.rows = rows;
        } else {
            face.columns = divide_by_size(width, options.patch_size);
            face.rows = divide_by_size(height, options.patch_size);
        }

        for (const bool back : {false, true}) {
            if (back && !scene.material(polygon).two_sided) break;
            if (back) {
                // Seen from behind: corners in reverse, starting so that sides keep their
                // direction.
                std::reverse(face.corners.begin(), face.corners.begin() + n);
                std::reverse(face.normals.begin(), face.normals.begin() + n);
                for (Vec3& m : face.normals) m = -m;
                face.normal = -face.normal;
                face.back = true;
            }
            // Normals that point behind the face say nothing about its side; use the geometric one.
            for (std::uint32_t i = 0; i < n; ++i)
                if (dot(face.normals[i], face.normal) < 0.2) face.normals[i] = {};
            for (std::uint32_t i = 0; i < n; ++i) {
                const PositionId a = face.corners[i], b = face.corners[(i + 1) % n];
                const auto [slot, fresh] =
                    edge_of.insert({Key{bits_of(std::min(a, b).value, std::max(a, b).value), 0},
                                    static_cast<std::uint32_t>(edges_.size())});
                if (fresh) edges_.push_back({std::min(a, b), std::max(a, b)});
                face.edges[i] = slot->second;
            }
            faces_.push_back(face);
        }
    }
    on_edge_.resize(edges_.size());
}

// Faces of one surface that meet along an edge share vertices if they are coplanar, or if the file
// gives them the same shading normals there.
void Mesh::join_smooth(const Scene& scene) {
    std::vector<std::vector<std::uint32_t>> around(edges_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (std::uint32_t i = 0; i < faces_[f].count; ++i)
            around[faces_[f].edges[i]].push_back(static_cast<std::uint32_t>(f));

    const auto normal_at = [&](const Face& face, PositionId corner) {
        for (std::uint32_t i = 0; i < face.count; ++i)
            if (face.corners[i] == corner)
                return face.normals[i] == Vec3{} ? face.normal : face.normals[i];
        return face.normal;
    };
    Sets sets(faces_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        for (const std::uint32_t f : around[e]) {
            for (const std::uint32_t g : around[e]) {
                if (g <= f) continue;
                const Face &a = faces_[f], &b = faces_[g];
                if (scene.surfaces[a.surface].material != scene.surfaces[b.surface].material ||
                    a.surface != b.surface)
                    continue;
                bool smooth = dot(a.normal, b.normal) > 0.5;
                for (const PositionId end : edges_[e]) {
                    const double cosine = dot(normal_at(a, end), normal_at(b, end));
                    smooth = smooth && cosine > smooth_cosine;
                }
                if (smooth || dot(a.normal, b.normal) > coplanar_cosine) sets.join(f, g);
            }
        }
    }
    for (std::size_t f = 0; f < faces_.size(); ++f)
        faces_[f].smooth = sets.find(static_cast<std::uint32_t>(f));
}

void Mesh::make_patches() {
    constexpr std::int32_t step = 1 << max_level;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        Face& face = faces_[f];
        face.first_patch = PatchId(patches_.size());
        const auto add = [&](std::int32_t u, std::int32_t v, std::int32_t size) {
            Element element;
            element.patch = PatchId(patches_.size());
            element.u = u, element.v = v, element.size = size;
            element.count = static_cast<std::uint8_t>(face.count);
            const ElementId id(elements_.size());
            elements_.push_back(element);
            patches_.push_back({FaceId(f), id, 0.0});
            make_corners(id);
            patches_.back().area = static_cast<double>(elements_.back().area);
        };
        for (std::uint32_t j = 0; j < face.rows; ++j) {
            const auto v = static_cast<std::int32_t>(j) * step;
            if (face.count == 4) {
                for (std::uint32_t i = 0; i < face.columns; ++i)
                    add(static_cast<std::int32_t>(i) * step, v, step);
            } else {
                for (std::uint32_t i = 0; i + j < face.columns; ++i) {
                    const auto u = static_cast<std::int32_t>(i) * step;
                    add(u, v, step);
                    if (i + j + 1 < face.columns) add(u + step, v + step, -step);
                }
            }
        }
    }
}

}  // namespace exitance
