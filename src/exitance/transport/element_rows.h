// SPDX-License-Identifier: Apache-2.0
// The rows of the linear system: the leaves of a mesh, each with one exitance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/mesh.h"
#include "exitance/visibility/place_owners.h"
#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// What the transport between elements is computed from; everything outlives its users.
struct ElementScene {
    const Mesh& mesh;
    const RayCaster& caster;  ///< over the scene's polygons
    const PlaceOwners& owners;
    std::span<const char> two_sided;  ///< per polygon

    const Face& face(ElementId id) const { return mesh.face_of(mesh[id]); }
    bool two_sided_face(const Face& face) const { return two_sided[face.polygon.index()]; }
};

struct ElementRows {
    std::vector<ElementId> elements;
    /// Area that neither stands under something else nor belongs to another polygon [m²].
    std::vector<float> area;

    std::size_t size() const { return elements.size(); }
};

/// All leaves of the mesh, or these of them.
ElementRows make_element_rows(const ElementScene& scene);
ElementRows make_element_rows(const ElementScene& scene, std::vector<ElementId> leaves);

/// Places at which the irradiance of an element is evaluated: Gauss points, four in a quadrilateral
/// and three in a triangle, whose weighted mean is exact for polynomials of the third and second
/// degree. Places under other things count for nothing.
struct RowPoints {
    Receivers receivers;
    std::vector<float> weight;         ///< per receiver; sums to 1 over an element, or is 0
    std::vector<std::uint32_t> begin;  ///< first receiver of a row, and the end
};

RowPoints make_row_points(const ElementScene& scene, const ElementRows& rows);

}  // namespace exitance
