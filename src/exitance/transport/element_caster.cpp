// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/element_caster.h"

#include <algorithm>
#include <bit>

#include "exitance/math/warp.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"
#include "exitance/visibility/hemisphere_rays.h"

namespace exitance {

namespace {

// The faces of a two-sided polygon lie in one place: each lets rays through to the other's front.
// Where polygons share a plane, the ones that do not own it lie behind by half a clearance (rays
// from the other side start a whole one away), so that rays end on the owner.
RayCaster make_caster(const ElementScene& scene, const ElementRows& rows) {
    std::vector<Vec3> points;
    std::vector<RayCaster::Face> faces;
    std::vector<char> open_backs;
    std::vector<float> transmittance;
    bool any_two_sided = false;
    for (const ElementId id : rows.elements) {
        const Element& element = scene.mesh[id];
        const Face& face = scene.face(id);
        const bool below = !scene.owners.covers(face.polygon, face.back).empty();
        const Vec3 shift = face.normal * (below ? -0.5 * scene.caster.clearance() : 0.0);
        const auto first = static_cast<std::uint32_t>(points.size());
        const auto corners = scene.mesh.corners(element);
        for (std::uint32_t c = 0; c < element.count; ++c) points.push_back(corners[c] + shift);
        faces.push_back({first, first + 1, first + 2, first + element.count - 1});
        open_backs.push_back(scene.two_sided_face(face));
        any_two_sided = any_two_sided || open_backs.back();
        transmittance.push_back(scene.caster.transmittance(face.polygon.value));
    }
    if (!any_two_sided) open_backs.clear();  // asking costs rays a call for every hit
    return RayCaster(points, faces, std::move(open_backs), std::move(transmittance));
}

// Indices in an order that keeps blocks of powers of two together: places and directions are two
// sequences, each stratified, that have nothing to do with each other (Burley 2020).
std::uint32_t shuffled(std::uint32_t i, std::uint64_t key) {
    return owen_scramble(i, static_cast<std::uint32_t>(key >> 16));
}

}  // namespace

ElementCaster::ElementCaster(const ElementScene& scene, const ElementRows& rows, std::uint32_t rays,
                             std::uint64_t seed)
    : scene_(scene),
      rows_(rows),
      caster_(make_caster(scene, rows)),
      places_(std::bit_ceil(std::max(rays, std::uint32_t{RayPacket::width})) / RayPacket::width),
      seed_(seed) {
    for (const ElementId id : rows.elements)
        two_sided_.push_back(scene.two_sided_face(scene.face(id)));
}

bool ElementCaster::cast_place(std::size_t row, std::uint32_t place, Ends& ends) const {
    const std::uint64_t key = hash_bits(seed_, rows_.elements[row].value);
    const auto at = low_discrepancy(hash_bits(key, 1), shuffled(place, hash_bits(key, 2)));
    return cast_from(row, at, key, place, ends);
}

bool ElementCaster::cast_from(std::size_t row, const UnitSquare& place, std::uint64_t key,
                              std::uint32_t packet, Ends& ends) const {
    const Element& element = scene_.mesh[rows_.elements[row]];
    const Face& face = scene_.mesh.face_of(element);
    const auto corners = scene_.mesh.corners(element);
    const Vec3 point = uniform_polygon({corners.data(), element.count}, place);
    if (!scene_.owners.owns(face.polygon, face.back, point - scene_.caster.middle())) return false;
    cast_packet(point, face.normal, key, packet, ends);
    // As in visibility/exposure.h: mostly backs are seen from inside a solid.
    return ends.black <= RayPacket::width / 2;
}

void ElementCaster::cast_packet(const Vec3& point, const Vec3& normal, std::uint64_t key,
                                std::uint32_t packet, Ends& ends) const {
    RayPacket rays;
    aim_hemisphere(rays, Vec3f(point + normal * caster_.clearance() - caster_.middle()),
                   Vec3f(normal), key, packet);
    cast(rays, ends);
}

void ElementCaster::cast(const RayPacket& rays, Ends& ends) const {
    ends.count = 0, ends.black = 0;
    std::array<float, RayPacket::width> through;
    through.fill(1.0f);
    RayCaster::PacketHits hits;
    closest_beyond_glass(caster_, rays, hits, [&](std::uint32_t k, const auto& met) {
        const std::uint32_t pane = met.primitive[k];
        if (met.front >> k & 1u) ends.add(met, k, through[k]);
        through[k] *= caster_.transmittance(pane);
    });
    for (std::uint32_t k = 0; k < RayPacket::width; ++k) {
        const std::uint32_t row = hits.primitive[k];
        if (row == 0xffffffffu || !(rays.active >> k & 1u)) continue;
        if (hits.front >> k & 1u)
            ends.add(hits, k, through[k]);
        else if (!two_sided_[row])
            ++ends.black;
    }
}

}  // namespace exitance
