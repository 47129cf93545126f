// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/clusters.h"

#include <algorithm>
#include <map>

#include "exitance/math/polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Faces of one smooth surface belong together where they lie in one plane; those that rounding
// parts are together in a volume cluster all the same.
using FaceKey = std::array<std::int64_t, 5>;

FaceKey key_of(const Face& face, const Vec3& corner, double diagonal) {
    const auto rounded = [](double x) { return static_cast<std::int64_t>(std::lround(x * 1e5)); };
    return {std::int64_t{face.smooth}, rounded(face.normal.x), rounded(face.normal.y),
            rounded(face.normal.z), rounded(dot(face.normal, corner) / diagonal)};
}

bool lies_in(std::span<const Vec3> corners, const Plane& plane, double slack) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vec3& p) { return std::abs(plane.height(p)) <= slack; });
}

}  // namespace

Clusters::Clusters(const Mesh& mesh) : mesh_(mesh), patches_(mesh.patches().size()) {
    // A tree of n patches has n − 1 clusters: elements can be numbered behind them from the start.
    clusters_.resize(patches_ > 0 ? patches_ - 1 : 0);
    Box bounds;
    for (const Vec3& p : mesh.positions()) bounds.add(p);
    const double diagonal = bounds.diagonal() > 0 ? bounds.diagonal() : 1.0;
    std::map<FaceKey, std::vector<Part>> faces;
    for (const Patch& patch : mesh.patches()) {
        const Face& face = mesh[patch.face];
        faces[key_of(face, mesh[face.corners[0]], diagonal)].push_back(of_patch(patch));
    }
    patches_ = 0;
    std::vector<Part> parts;
    for (auto& [key, members] : faces) parts.push_back(join(members, 0, members.size()));
    if (!parts.empty()) root_ = join(parts, 0, parts.size()).node;
    // Children have lower numbers than their parents, so that planes and places come up from them.
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
        clusters_[i].plane = plane_of(NodeId(i), 1e-6 * diagonal);
        for (std::uint32_t k = 0; k < Cluster::places_count; ++k)
            clusters_[i].places[k] = place_in(NodeId(i), low_discrepancy(hash_bits(0xc1u, i), k));
    }
}

Clusters::Part Clusters::of_patch(const Patch& patch) const {
    const auto corners = mesh_.corners(mesh_[patch.root]);
    Part part{node(patch.root), {}, patch.area};
    for (std::uint32_t c = 0; c < mesh_[patch.root].count; ++c) part.box.add(corners[c]);
    return part;
}

// Halved across the longest extent of the middles, again and again.
Clusters::Part Clusters::join(std::vector<Part>& parts, std::size_t begin, std::size_t end) {
    if (end - begin == 1) return parts[begin];
    Box centres;
    for (std::size_t i = begin; i < end; ++i) centres.add(parts[i].box.centre());
    const Vec3 size = centres.size();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return parts.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](const Part& a, const Part& b) {
        const double x = a.box.centre()[axis], y = b.box.centre()[axis];
        return x != y ? x < y : a.node < b.node;
    });
    const Part first = join(parts, begin, middle), second = join(parts, middle, end);
    Part whole{NodeId(patches_), first.box, first.area + second.area};
    whole.box.add(second.box.lower);
    whole.box.add(second.box.upper);
    Cluster& made = clusters_[patches_++];
    made.children = {first.node, second.node};
    made.box = whole.box;
    made.area = whole.area;
    return whole;
}

double Clusters::area_of(NodeId node) const {
    return is_cluster(node) ? cluster(node).area : double(mesh_[element(node)].area);
}

std::optional<Plane> Clusters::plane_of(NodeId node, double slack) const {
    if (!is_cluster(node)) {
        const Face& face = mesh_.face_of(mesh_[element(node)]);
        return Plane{face.normal, dot(face.normal, mesh_[face.corners[0]])};
    }
    const auto [first, second] = cluster(node).children;
    const std::optional<Plane> a =
        is_cluster(first) ? cluster(first).plane : plane_of(first, slack);
    const std::optional<Plane> b =
        is_cluster(second) ? cluster(second).plane : plane_of(second, slack);
    if (!a || !b || dot(a->normal, b->normal) < 1 - 1e-9) return {};
    // Little by little a plane may turn: every corner has the last word.
    std::vector<NodeId> open{first, second};
    while (!open.empty()) {
        const NodeId next = open.back();
        open.pop_back();
        if (is_cluster(next)) {
            for (const NodeId child : cluster(next).children) open.push_back(child);
            continue;
        }
        const auto corners = mesh_.corners(mesh_[element(next)]);
        if (!lies_in({corners.data(), mesh_[element(next)].count}, *a, slack)) return {};
    }
    return a;
}

FacePlace Clusters::place_in(NodeId node, std::array<double, 2> u) const {
    while (is_cluster(node)) {
        const auto [first, second] = cluster(node).children;
        const double share = area_of(first) / (area_of(first) + area_of(second));
        const bool in_first = u[0] < share;
        u[0] = in_first ? u[0] / share : (u[0] - share) / (1 - share);
        node = in_first ? first : second;
    }
    const Element& at = mesh_[element(node)];
    const auto corners = mesh_.corners(at);
    u[0] = std::clamp(u[0], 0.0, 1 - 1e-12);
    return {uniform_polygon({corners.data(), at.count}, u), mesh_[at.patch].face};
}

}  // namespace exitance
