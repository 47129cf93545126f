// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include "exitance/math/box_tree.h"
#include "exitance/math/disjoint_sets.h"
#include "exitance/math/polygon.h"
#include "exitance/mesh/weld.h"
#include "exitance/visibility/blocker.h"

namespace exitance {

namespace {

using Loop = std::vector<std::uint32_t>;  // welded corners in order

constexpr std::uint64_t directed(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32 | to;
}

class Finder {
  public:
    explicit Finder(std::span<const std::span<const Vec3>> polygons) {
        Box bounds;
        for (const auto& polygon : polygons)
            for (const Vec3& p : polygon) bounds.add(p);
        Welder welder(bounds, positions_);
        tolerance_ = welder.tolerance();
        std::map<Loop, std::uint32_t> seen;
        for (const auto& polygon : polygons) {
            Loop loop;
            for (const Vec3& p : polygon) {
                const auto at = static_cast<std::uint32_t>(welder.at(p).index());
                if (loop.empty() || (at != loop.back() && at != loop.front())) loop.push_back(at);
            }
            if (loop.size() < 3) continue;
            Loop key = loop;
            std::sort(key.begin(), key.end());
            const auto [same, fresh] =
                seen.insert({key, static_cast<std::uint32_t>(loops_.size())});
            if (!fresh) {
                twice_[same->second] = 1;
                continue;
            }
            const auto outline = points(loop);
            const Vec3 normal = unit_normal(outline);
            loops_.push_back(std::move(loop));
            planes_.push_back({normal, dot(normal, centroid(outline))});
            twice_.push_back(0);
        }
    }

    std::vector<Blocker> blockers() {
        for (std::uint32_t i = 0; i < loops_.size(); ++i)
            for (std::size_t k = 0; k < loops_[i].size(); ++k) {
                auto& owner = owners_[edge(loops_[i], k)];
                owner = owner.count == 0 ? Owner{i, 1} : Owner{owner.polygon, 2};
            }
        DisjointSets bodies(loops_.size()), faces(loops_.size());
        for (std::uint32_t i = 0; i < loops_.size(); ++i)
            for (std::size_t k = 0; k < loops_[i].size(); ++k) {
                const auto other = neighbour(loops_[i], k);
                if (!other) continue;
                bodies.join(i, *other);
                if (coplanar(i, *other)) faces.join(i, *other);
            }
        face_of_.resize(loops_.size());
        for (std::uint32_t i = 0; i < loops_.size(); ++i) face_of_[i] = faces.find(i);

        std::vector<Box> boxes;
        for (const Loop& loop : loops_) boxes.push_back(box(loop));
        const BoxTree tree(boxes);
        std::vector<Blocker> found;
        for (const auto& body : bodies.members()) {
            std::map<std::uint32_t, std::vector<std::uint32_t>> by_face;
            for (const std::uint32_t i : body) by_face[face_of_[i]].push_back(i);
            std::vector<std::vector<Loop>> outlines;
            for (const auto& [face, members] : by_face) outlines.push_back(merged(members));
            if (auto solid = as_solid(body, by_face, outlines);
                solid && is_empty(*solid, body, tree)) {
                found.push_back(std::move(*solid));
                continue;
            }
            std::size_t at = 0;
            for (const auto& [face, members] : by_face) {
                for (const Loop& outline : outlines[at])
                    if (!has_all_on_one_side(planes_[face]))
                        found.push_back(make_sheet(points(outline), planes_[face]));
                ++at;
            }
        }
        return found;
    }

  private:
    struct Owner {
        std::uint32_t polygon = 0, count = 0;
    };

    static std::uint64_t edge(const Loop& loop, std::size_t k) {
        return directed(loop[k], loop[(k + 1) % loop.size()]);
    }
    std::vector<Vec3> points(const Loop& loop) const {
        std::vector<Vec3> at;
        for (const std::uint32_t i : loop) at.push_back(positions_[i]);
        return at;
    }
    Box box(const Loop& loop) const {
        Box found;
        for (const std::uint32_t i : loop) found.add(positions_[i]);
        return found;
    }
    /// The polygon on the other side of edge k, if there is just one and it runs the other way.
    std::optional<std::uint32_t> neighbour(const Loop& loop, std::size_t k) const {
        const std::uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
        const auto there = owners_.find(directed(b, a));
        if (there == owners_.end() || there->second.count != 1) return {};
        if (owners_.at(directed(a, b)).count != 1) return {};
        return there->second.polygon;
    }
    bool coplanar(std::uint32_t i, std::uint32_t j) const {
        if (dot(planes_[i].normal, planes_[j].normal) < 0.5) return false;
        const auto on = [&](std::uint32_t plane, std::uint32_t polygon) {
            return std::all_of(
                loops_[polygon].begin(), loops_[polygon].end(), [&](std::uint32_t p) {
                    return std::abs(planes_[plane].height(positions_[p])) <= tolerance_;
                });
        };
        return on(i, j) && on(j, i);
    }

    // Corners at which the outline goes straight on are left out.
    Loop without_straight_corners(const Loop& loop) const {
        Loop kept;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 &a = positions_[loop[(i + loop.size() - 1) % loop.size()]],
                       &b = positions_[loop[i]], &c = positions_[loop[(i + 1) % loop.size()]];
            if (length(cross(b - a, c - b)) > 1e-9 * length(b - a) * length(c - b))
                kept.push_back(loop[i]);
        }
        return kept;
    }

    /// Convex polygons that cover what the polygons of one face do: neighbours are joined as long
    /// as the result is convex.
    std::vector<Loop> merged(const std::vector<std::uint32_t>& members) const {
        if (auto whole = convex_outline(members)) return {*whole};
        std::vector<Loop> parts;
        std::unordered_map<std::uint64_t, std::size_t> owner;
        for (const std::uint32_t i : members) {
            for (std::size_t k = 0; k < loops_[i].size(); ++k)
                owner[edge(loops_[i], k)] = parts.size();
            parts.push_back(without_straight_corners(loops_[i]));
            for (std::size_t k = 0; k < parts.back().size(); ++k)
                owner[edge(parts.back(), k)] = parts.size() - 1;
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t p = 0; p < parts.size(); ++p) {
                for (std::size_t k = 0; k < parts[p].size(); ++k) {
                    const std::uint32_t a = parts[p][k], b = parts[p][(k + 1) % parts[p].size()];
                    const auto there = owner.find(directed(b, a));
                    if (there == owner.end()) continue;
                    const std::size_t q = there->second;
                    const auto joined = q == p ? std::nullopt : join(parts[p], k, parts[q], b);
                    if (!joined) continue;
                    for (const std::size_t old : {p, q})
                        for (std::size_t e = 0; e < parts[old].size(); ++e)
                            owner.erase(edge(parts[old], e));
                    parts[q].clear();
                    parts[p] = *joined;
                    for (std::size_t e = 0; e < parts[p].size(); ++e) owner[edge(parts[p], e)] = p;
                    changed = true;
                    k = static_cast<std::size_t>(-1);  // look at the new outline from its start
                }
            }
        }
        std::erase_if(parts, [](const Loop& part) { return part.empty(); });
        return parts;
    }

    /// The outline of the whole face, if it is one and convex.
    std::optional<Loop> convex_outline(const std::vector<std::uint32_t>& members) const {
        std::unordered_map<std::uint32_t, std::uint32_t> next;
        for (const std::uint32_t i : members)
            for (std::size_t k = 0; k < loops_[i].size(); ++k) {
                const auto other = neighbour(loops_[i], k);
                if (other && face_of_[*other] == face_of_[i]) continue;
                if (!next.insert({loops_[i][k], loops_[i][(k + 1) % loops_[i].size()]}).second)
                    return {};
            }
        if (next.empty()) return {};
        const std::uint32_t start = loops_[members[0]][0];
        std::uint32_t first = next.contains(start) ? start : next.begin()->first, at = first;
        Loop loop;
        do {
            loop.push_back(at);
            const auto step = next.find(at);
            if (step == next.end()) return {};
            at = step->second;
        } while (at != first && loop.size() <= next.size());
        if (loop.size() != next.size()) return {};
        loop = without_straight_corners(loop);
        if (loop.size() < 3 || !is_strictly_convex(points(loop))) return {};
        return loop;
    }

    // `p` and `q` share edge k of p, which begins at `b` in q.
    std::optional<Loop> join(const Loop& p, std::size_t k, const Loop& q, std::uint32_t b) const {
        const auto start = static_cast<std::size_t>(std::find(q.begin(), q.end(), b) - q.begin());
        if (start == q.size() || q[(start + 1) % q.size()] != p[k]) return {};
        Loop around;
        for (std::size_t i = 0; i < p.size(); ++i) around.push_back(p[(k + 1 + i) % p.size()]);
        for (std::size_t i = 2; i < q.size(); ++i) around.push_back(q[(start + i) % q.size()]);
        around = without_straight_corners(around);
        if (around.size() < 3 || !is_strictly_convex(points(around))) return {};
        return around;
    }

    std::optional<Blocker> as_solid(
        const std::vector<std::uint32_t>& body,
        const std::map<std::uint32_t, std::vector<std::uint32_t>>& by_face,
        const std::vector<std::vector<Loop>>& outlines) const {
        if (by_face.size() < 4) return {};
        for (const std::uint32_t i : body) {
            if (twice_[i]) return {};
            for (std::size_t k = 0; k < loops_[i].size(); ++k)
                if (!neighbour(loops_[i], k)) return {};
        }
        Blocker solid;
        solid.solid = true;
        std::map<std::uint32_t, std::uint32_t> renamed;
        std::map<std::uint64_t, std::uint32_t> left;
        std::size_t at = 0;
        for (const auto& [face, members] : by_face) {
            if (outlines[at].size() != 1) return {};
            const Loop& outline = outlines[at++][0];
            for (std::size_t k = 0; k < outline.size(); ++k)
                left[edge(outline, k)] = static_cast<std::uint32_t>(solid.planes.size());
            solid.planes.push_back(planes_[face]);
            for (const std::uint32_t p : outline)
                if (renamed.insert({p, static_cast<std::uint32_t>(solid.corners.size())}).second) {
                    solid.corners.push_back(positions_[p]);
                    solid.bounds.add(positions_[p]);
                }
        }
        for (const Plane& plane : solid.planes)
            for (const Vec3& corner : solid.corners)
                if (plane.height(corner) > tolerance_) return {};
        for (const auto& [key, face] : left) {
            const auto from = static_cast<std::uint32_t>(key >> 32);
            const auto to = static_cast<std::uint32_t>(key);
            const auto other = left.find(directed(to, from));
            if (other == left.end()) return {};
            if (from < to)
                solid.edges.push_back({renamed.at(from), renamed.at(to), face, other->second});
        }
        return solid;
    }

    /// What is inside a closed body sees other things inside, so the body cannot be one obstacle.
    bool is_empty(const Blocker& solid, const std::vector<std::uint32_t>& body,
                  const BoxTree& tree) const {
        const std::set<std::uint32_t> own(body.begin(), body.end());
        bool empty = true;
        tree.for_overlapping(solid.bounds, [&](std::uint32_t i) {
            if (!empty || own.contains(i)) return;
            auto places = points(loops_[i]);
            places.push_back(centroid(places));
            for (const Vec3& p : places)
                empty = empty &&
                        !std::all_of(solid.planes.begin(), solid.planes.end(),
                                     [&](const Plane& f) { return f.height(p) < -tolerance_; });
        });
        return empty;
    }

    bool has_all_on_one_side(const Plane& plane) const {
        bool above = false, below = false;
        for (const Vec3& p : positions_) {
            const double height = plane.height(p);
            above = above || height > tolerance_;
            below = below || height < -tolerance_;
            if (above && below) return false;
        }
        return true;
    }

    std::vector<Vec3> positions_;
    std::vector<Loop> loops_;
    std::vector<Plane> planes_;
    std::vector<char> twice_;
    std::vector<std::uint32_t> face_of_;
    std::unordered_map<std::uint64_t, Owner> owners_;
    double tolerance_ = 0;
};

}  // namespace

std::vector<Blocker> find_blockers(std::span<const std::span<const Vec3>> polygons) {
    return Finder(polygons).blockers();
}

}  // namespace exitance
