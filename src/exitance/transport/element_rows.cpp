// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/element_rows.h"

#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/random.h"
#include "exitance/visibility/exposure.h"

namespace exitance {

namespace {

// Places per element that tell which share of it is open, where its corners and middle disagree:
// a share is known to a few hundredths.
constexpr std::uint32_t places = 64;

/// Which of `points` are open to the room and their polygon's own.
std::vector<char> find_open(const ElementScene& scene, const Receivers& points,
                            std::span<const ElementId> element) {
    std::vector<char> open(points.size());
    find_exposed(scene.caster, scene.two_sided, points, 0, open);
    for (std::size_t i = 0; i < open.size(); ++i) {
        const Face& face = scene.face(element[i]);
        open[i] = open[i] && scene.owners.owns(face.polygon, face.back, Vec3(points.point(i)));
    }
    return open;
}

struct Places {
    Receivers points;
    std::vector<ElementId> element;

    void add(const ElementScene& scene, ElementId id, const Vec3& place) {
        points.add(place - scene.caster.middle(), scene.face(id).normal,
                   static_cast<std::uint32_t>(hash_bits(id.value, element.size())));
        element.push_back(id);
    }
};

/// Open share of each element by the places `of(id, place)` lists, equally many for all of them.
template <class Of>
std::vector<float> open_shares(const ElementScene& scene, std::span<const ElementId> elements,
                               const Of& of) {
    Places all;
    for (const ElementId id : elements)
        of(id, [&](const Vec3& place) { all.add(scene, id, place); });
    const std::vector<char> open = find_open(scene, all.points, all.element);
    std::vector<float> shares;
    for (std::size_t i = 0; i < open.size();) {
        const std::size_t first = i;
        float sum = 0;
        for (; i < open.size() && all.element[i] == all.element[first]; ++i) sum += open[i] ? 1 : 0;
        shares.push_back(sum / static_cast<float>(i - first));
    }
    return shares;
}

}  // namespace

ElementRows make_element_rows(const ElementScene& scene) {
    std::vector<ElementId> leaves;
    for (const Patch& patch : scene.mesh.patches())
        scene.mesh.for_leaves(patch.root, [&](ElementId id) { leaves.push_back(id); });
    return make_element_rows(scene, std::move(leaves));
}

ElementRows make_element_rows(const ElementScene& scene, std::vector<ElementId> leaves) {
    ElementRows rows;
    const Mesh& mesh = scene.mesh;
    rows.elements = std::move(leaves);
    std::vector<float> shares =
        open_shares(scene, rows.elements, [&](ElementId id, const auto& add) {
            const auto corners = mesh.corners(mesh[id]);
            const Vec3 middle = centroid({corners.data(), mesh[id].count});
            add(middle);
            for (std::uint32_t c = 0; c < mesh[id].count; ++c)
                add(corners[c] * 0.99 + middle * 0.01);
        });
    std::vector<ElementId> unclear;
    std::vector<std::size_t> row_of_unclear;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (shares[i] == 1.0f) continue;
        unclear.push_back(rows.elements[i]);
        row_of_unclear.push_back(i);
    }
    const std::vector<float> fine = open_shares(scene, unclear, [&](ElementId id, const auto& add) {
        const auto corners = mesh.corners(mesh[id]);
        for (std::uint32_t k = 0; k < places; ++k)
            add(uniform_polygon({corners.data(), mesh[id].count},
                                low_discrepancy(hash_bits(id.value, 0x0deau), k)));
    });
    for (std::size_t k = 0; k < fine.size(); ++k) shares[row_of_unclear[k]] = fine[k];
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows.area.push_back(shares[i] * mesh[rows.elements[i]].area);
    return rows;
}

RowPoints make_row_points(const ElementScene& scene, const ElementRows& rows) {
    RowPoints out;
    const Mesh& mesh = scene.mesh;
    Places all;
    const double gauss = 0.5 / std::sqrt(3.0);
    for (const ElementId id : rows.elements) {
        out.begin.push_back(static_cast<std::uint32_t>(all.element.size()));
        const auto c = mesh.corners(mesh[id]);
        if (mesh[id].count == 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                all.add(scene, id, (c[k] * 4.0 + c[(k + 1) % 3] + c[(k + 2) % 3]) / 6.0);
                out.weight.push_back(1.0f);
            }
            continue;
        }
        for (const double u : {0.5 - gauss, 0.5 + gauss})
            for (const double v : {0.5 - gauss, 0.5 + gauss}) {
                all.add(scene, id,
                        (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v);
                const Vec3 along_u = (c[1] - c[0]) * (1 - v) + (c[2] - c[3]) * v;
                const Vec3 along_v = (c[3] - c[0]) * (1 - u) + (c[2] - c[1]) * u;
                out.weight.push_back(static_cast<float>(length(cross(along_u, along_v))));
            }
    }
    out.begin.push_back(static_cast<std::uint32_t>(all.element.size()));
    const std::vector<char> open = find_open(scene, all.points, all.element);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        float sum = 0;
        for (std::uint32_t k = out.begin[i]; k < out.begin[i + 1]; ++k)
            sum += out.weight[k] *= open[k] ? 1.0f : 0.0f;
        for (std::uint32_t k = out.begin[i]; sum > 0 && k < out.begin[i + 1]; ++k)
            out.weight[k] /= sum;
    }
    out.receivers = std::move(all.points);
    return out;
}

}  // namespace exitance
