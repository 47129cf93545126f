// SPDX-License-Identifier: Apache-2.0
// What an index indexes is part of its type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace exitance {

template <class Tag>
struct Id {
    std::uint32_t value = 0xffffffffU;

    constexpr Id() = default;
    constexpr explicit Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
    constexpr bool valid() const { return value != 0xffffffffU; }
    constexpr std::size_t index() const { return value; }
    friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using PolygonId = Id<struct PolygonTag>;    ///< into Scene::polygons
using FaceId = Id<struct FaceTag>;          ///< one side of a polygon
using PatchId = Id<struct PatchTag>;        ///< what shoots
using ElementId = Id<struct ElementTag>;    ///< node of a quadtree under a patch
using RowId = Id<struct RowTag>;            ///< a leaf element as a row of the linear system
using VertexId = Id<struct VertexTag>;      ///< where light is received
using PositionId = Id<struct PositionTag>;  ///< a place; vertices of several faces may share it

}  // namespace exitance
