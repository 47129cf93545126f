// SPDX-License-Identifier: Apache-2.0
// Places that are looked at before the mesh has a vertex there; neighbours share them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "exitance/mesh/mesh.h"
#include "exitance/run/random.h"

namespace exitance {

struct PlaceOnFace {
    FaceId face;
    std::int32_t u, v;  ///< on the lattice of the face
    friend bool operator==(const PlaceOnFace&, const PlaceOnFace&) = default;
};

struct HashOfPlace {
    std::size_t operator()(const PlaceOnFace& p) const {
        return hash_bits(p.face.value, static_cast<std::uint32_t>(p.u),
                         static_cast<std::uint32_t>(p.v));
    }
};

}  // namespace exitance
