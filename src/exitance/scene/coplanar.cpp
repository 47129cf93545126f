// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/coplanar.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>

#include "exitance/math/polygon.h"
#include "exitance/run/random.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

constexpr double parallel = 1e-5;         // sine of the angle up to which normals agree
constexpr double least_share = 1e-3;      // of the smaller face, from which an overlap counts
constexpr std::size_t most_pairs = 1000;  // reported at most
constexpr std::uint64_t most_tests = 50'000'000;

// A polygon with its plane, relative to the middle of the scene.
struct Face {
    std::array<Vec3, 4> corners;
    std::uint32_t size = 0, polygon = 0;
    Vec3 normal, centre;
    Box box;
    double area = 0, tolerance = 0;
    int level = 0;  // its box fits into cells of edge 2^level

    std::span<const Vec3> span() const { return {corners.data(), size}; }
};

// Whole numbers that name a cell; positions close to a border belong to both sides of it.
struct Interval {
    std::int64_t first, last;
};

Interval cells(double low, double high, double edge) {
    return {static_cast<std::int64_t>(std::floor(low / edge)),
            static_cast<std::int64_t>(std::floor(high / edge))};
}

// Part of `subject` inside the convex `clip`, both seen along `normal` (Sutherland and Hodgman
// 1974); returns its area.
double common_area(std::span<const Vec3> subject, std::span<const Vec3> clip, const Vec3& normal) {
    std::vector<Vec3> kept(subject.begin(), subject.end()), next;
    for (std::size_t i = 0; i < clip.size() && !kept.empty(); ++i) {
        const Vec3& a = clip[i];
        const Vec3 inward = cross(normal, clip[(i + 1) % clip.size()] - a);
        next.clear();
        for (std::size_t j = 0; j < kept.size(); ++j) {
            const Vec3 &p = kept[j], &q = kept[(j + 1) % kept.size()];
            const double dp = dot(p - a, inward), dq = dot(q - a, inward);
            if (dp >= 0) next.push_back(p);
            if ((dp < 0) != (dq < 0)) next.push_back(p + (q - p) * (dp / (dp - dq)));
        }
        kept.swap(next);
    }
    return kept.size() < 3 ? 0 : std::abs(dot(vector_area(kept), normal));
}

bool share_area(const Face& a, const Face& b) {
    if (dot(a.normal, b.normal) <= 0 || length(cross(a.normal, b.normal)) > parallel) return false;
    const double apart = std::max(a.tolerance, b.tolerance);
    if (std::abs(dot(a.normal, b.centre - a.centre)) > apart) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (a.box.lower[axis] > b.box.upper[axis] + apart ||
            b.box.lower[axis] > a.box.upper[axis] + apart)
            return false;
    return common_area(a.span(), b.span(), b.normal) > least_share * std::min(a.area, b.area);
}

std::vector<Face> faces_of(const Scene& scene) {
    const Box bounds = scene.bounds();
    const double extent = bounds.diagonal();
    std::vector<Face> faces;
    for (std::uint32_t i = 0; i < scene.polygons.size(); ++i) {
        Face face;
        face.polygon = i;
        face.size = scene.polygons[i].size();
        face.corners = scene.corners(scene.polygons[i]);
        for (std::uint32_t c = 0; c < face.size; ++c) {
            face.corners[c] -= bounds.centre();
            face.box.add(face.corners[c]);
        }
        const Vec3 vector = vector_area(face.span());
        face.area = length(vector);
        const double diagonal = face.box.diagonal();
        if (!(face.area > 0) || !std::isfinite(face.area * extent)) continue;
        face.normal = vector / face.area;
        face.centre = centroid(face.span());
        face.tolerance = planarity_tolerance(diagonal, extent);
        const Vec3 size = face.box.size();
        // Cells are not made smaller than whole numbers can count across the scene.
        std::frexp(std::max({size.x, size.y, size.z, extent * 0x1.0p-40}), &face.level);
        faces.push_back(face);
    }
    return faces;
}

// Faces that have the same corners, in any order. Returns those that are there once.
std::vector<Face> take_duplicates(const std::vector<Face>& faces, FaceOverlaps& found) {
    const auto key_of = [](const Face& face) {
        std::array<std::uint64_t, 4> corners{};
        for (std::uint32_t c = 0; c < face.size; ++c) {
            const Vec3 p = face.corners[c] + Vec3{};  // −0 becomes 0
            corners[c] =
                hash_bits(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                          std::bit_cast<std::uint64_t>(p.z));
        }
        std::sort(corners.begin(), corners.end());
        return hash_bits(corners[0], corners[1], corners[2], corners[3]);
    };
    std::unordered_map<std::uint64_t, std::array<std::uint32_t, 2>> seen;  // one per side
    std::vector<Face> once;
    std::vector<Vec3> normals(1);
    for (const Face& face : faces) {
        auto& sides = seen[key_of(face)];
        const bool other_side = sides[0] != 0 && dot(face.normal, normals[sides[0]]) < 0;
        std::uint32_t& before = sides[other_side ? 1 : 0];
        if (before != 0) {
            if (found.duplicates.size() < most_pairs)
                found.duplicates.push_back({once[before - 1].polygon, face.polygon});
            else
                found.complete = false;
            continue;
        }
        once.push_back(face);
        normals.push_back(face.normal);
        before = static_cast<std::uint32_t>(once.size());
    }
    return once;
}

// Faces by plane and place: all that could overlap one stand in the few cells around it.
class PlaneGrid {
  public:
    PlaneGrid(const std::vector<Face>& faces, double extent) : plane_edge_(extent * 1e-3) {
        for (std::uint32_t f = 0; f < faces.size(); ++f) {
            const std::uint64_t plane = plane_keys(faces[f], 0).front();
            levels_[plane] |= level_bit(faces[f].level);
            for_cells(faces[f], faces[f].level, [&](std::uint64_t cell) {
                entries_.push_back({hash_bits(plane, cell), f});
            });
        }
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
            return a.key != b.key ? a.key < b.key : a.face < b.face;
        });
    }

    /// Calls `visit` with every face that may share a plane and a cell with `face` and is not
    /// smaller by a factor of two or more; some several times.
    template <class Visit>
    void near(const Face& face, const Visit& visit) const {
        for (const std::uint64_t plane : plane_keys(face, parallel)) {
            const auto levels = levels_.find(plane);
            if (levels == levels_.end()) continue;
            for (int level = face.level; level <= highest; ++level) {
                if ((levels->second & level_bit(level)) == 0) continue;
                for_cells(face, level, [&](std::uint64_t cell) {
                    const std::uint64_t key = hash_bits(plane, cell);
                    auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                               [](const Entry& entry, std::uint64_t wanted) {
                                                   return entry.key < wanted;
                                               });
                    for (; at != entries_.end() && at->key == key; ++at)
                        if (!visit(at->face)) return;
                });
            }
        }
    }

  private:
    struct Entry {
        std::uint64_t key;
        std::uint32_t face;
    };
    static constexpr int lowest = -31, highest = 32;

    static std::uint64_t level_bit(int level) {
        return std::uint64_t{1} << (std::clamp(level, lowest, highest) - lowest);
    }

    // The cells of the four numbers of the plane; with `slack`, also those just across a border.
    std::vector<std::uint64_t> plane_keys(const Face& face, double slack) const {
        constexpr double normal_edge = 1.0 / 256;
        const double along = dot(face.normal, face.centre);
        const double turn = slack * (length(face.centre) + face.box.diagonal());
        const double apart = slack > 0 ? turn + 2 * face.tolerance : 0;
        // Half a cell on, so that the axes and the middle lie inside a cell.
        const auto around = [](double value, double reach, double edge) {
            return cells(value + edge / 2 - reach, value + edge / 2 + reach, edge);
        };
        const Interval x = around(face.normal.x, slack, normal_edge);
        const Interval y = around(face.normal.y, slack, normal_edge);
        const Interval z = around(face.normal.z, slack, normal_edge);
        const Interval d = around(along, apart, plane_edge_);
        std::vector<std::uint64_t> keys;
        for (std::int64_t i = x.first; i <= x.last; ++i)
            for (std::int64_t j = y.first; j <= y.last; ++j)
                for (std::int64_t k = z.first; k <= z.last; ++k)
                    for (std::int64_t l = d.first; l <= d.last; ++l)
                        keys.push_back(hash_bits(static_cast<std::uint64_t>(i), j, k, l));
        return keys;
    }

    // The cells of edge 2^level that the box of a face touches: two along an axis at most.
    template <class Visit>
    void for_cells(const Face& face, int level, const Visit& visit) const {
        const double edge = std::ldexp(1.0, level);
        const auto along = [&](std::size_t axis) {
            return cells(face.box.lower[axis] - face.tolerance,
                         face.box.upper[axis] + face.tolerance, edge);
        };
        const Interval x = along(0), y = along(1), z = along(2);
        for (std::int64_t i = x.first; i <= x.last; ++i)
            for (std::int64_t j = y.first; j <= y.last; ++j)
                for (std::int64_t k = z.first; k <= z.last; ++k)
                    visit(hash_bits(static_cast<std::uint64_t>(level) + 1024, i, j, k));
    }

    double plane_edge_;
    std::vector<Entry> entries_;
    std::unordered_map<std::uint64_t, std::uint64_t> levels_;  // per plane, bits of level_bit()
};

}  // namespace

FaceOverlaps find_overlaps(const Scene& scene) {
    FaceOverlaps found;
    const std::vector<Face> faces = take_duplicates(faces_of(scene), found);
    if (faces.empty()) return found;
    const PlaneGrid grid(faces, scene.bounds().diagonal());
    std::vector<std::uint32_t> last_tested(faces.size(), 0xffffffffU);
    std::uint64_t tests = 0;
    for (std::uint32_t f = 0; f < faces.size() && found.complete; ++f)
        grid.near(faces[f], [&](std::uint32_t other) {
            // Of two faces of one level, the later looks for the earlier.
            if (other == f || last_tested[other] == f ||
                (faces[other].level == faces[f].level && other > f))
                return true;
            last_tested[other] = f;
            if (++tests > most_tests || found.overlaps.size() >= most_pairs) {
                found.complete = false;
                return false;
            }
            const std::uint32_t a = faces[f].polygon, b = faces[other].polygon;
            if (share_area(faces[f], faces[other]))
                found.overlaps.push_back({std::min(a, b), std::max(a, b)});
            return true;
        });
    return found;
}

}  // namespace exitance
