// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/patch_slopes.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Neighbours on one line tell nothing of what happens across it: then that slope is 0. A share of
// what they do tell, for those of a sliver lie thousands of its own widths away.
constexpr float least_evidence = 1e-3f;

struct HashOfSide {
    std::size_t operator()(std::uint64_t side) const { return hash_bits(side); }
};

Vec3 middle_of(const Mesh& mesh, const Element& element) {
    const auto corners = mesh.corners(element);
    return centroid({corners.data(), element.count});
}

}  // namespace

PatchSlopes::PatchSlopes(const Mesh& mesh, std::span<const float> open_area)
    : mesh_(mesh), beside_(mesh.patches().size()), count_(mesh.patches().size(), 0) {
    tsl::robin_map<std::uint64_t, std::uint32_t, HashOfSide> waiting;
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        if (!(open_area[p] > 0)) continue;
        const Element& root = mesh[mesh.patches()[p].root];
        for (std::uint32_t i = 0; i < root.count; ++i) {
            const auto [a, b] =
                std::minmax(root.vertices[i].value, root.vertices[(i + 1) % root.count].value);
            const auto [side, fresh] =
                waiting.insert({std::uint64_t{a} << 32 | b, static_cast<std::uint32_t>(p)});
            if (fresh) continue;
            meet(PatchId(p), PatchId(side->second));
            meet(PatchId(side->second), PatchId(p));
        }
    }
}

void PatchSlopes::meet(PatchId patch, PatchId other) {
    std::uint8_t& count = count_[patch.index()];
    if (count == beside_[patch.index()].size()) return;
    const Element& root = mesh_[mesh_[patch].root];
    const auto corners = mesh_.corners(root);
    const Vec3 a = corners[1] - corners[0], b = corners[root.count - 1u] - corners[0];
    const Vec3 d = middle_of(mesh_, mesh_[mesh_[other].root]) - middle_of(mesh_, root);
    // The (s, t) for which s a + t b comes nearest to d.
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), det = aa * bb - ab * ab;
    if (!(det > 0)) return;
    const double s = (dot(d, a) * bb - dot(d, b) * ab) / det;
    const double t = (dot(d, b) * aa - dot(d, a) * ab) / det;
    beside_[patch.index()][count++] = {other.value, static_cast<float>(s), static_cast<float>(t)};
}

void PatchSlopes::find(PatchId patch, const RowField& values, std::span<float> s,
                       std::span<float> t) const {
    std::fill(s.begin(), s.end(), 0.0f);
    std::fill(t.begin(), t.end(), 0.0f);
    const std::span beside(beside_[patch.index()].data(), count_[patch.index()]);
    if (beside.empty()) return;
    float ss = 0, st = 0, tt = 0;
    for (const Neighbour& n : beside) ss += n.s * n.s, st += n.s * n.t, tt += n.t * n.t;
    const float least = least_evidence * (ss + tt);
    ss += least, tt += least;
    const float det = ss * tt - st * st;
    if (!(det > 0)) return;  // all lie in the same place
    const auto here = values[RowId(patch.index())];
    // From the middle to the farthest corner, along one side.
    const float half = mesh_[mesh_[patch].root].count == 3 ? 2.0f / 3 : 0.5f;
    for (std::size_t c = 0; c < s.size(); ++c) {
        float along_s = 0, along_t = 0;
        for (const Neighbour& n : beside) {
            const float more = values[RowId(n.patch)][c] - here[c];
            along_s += n.s * more, along_t += n.t * more;
        }
        s[c] = (along_s * tt - along_t * st) / det;
        t[c] = (along_t * ss - along_s * st) / det;
        const float most = half * (std::abs(s[c]) + std::abs(t[c]));
        // What a rough mesh extrapolates may be below nothing already.
        const float room = std::max(here[c], 0.0f);
        if (most > room) s[c] *= room / most, t[c] *= room / most;
    }
}

}  // namespace exitance
