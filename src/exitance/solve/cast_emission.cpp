// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/cast_emission.h"

#include <algorithm>

#include "exitance/math/polygon.h"
#include "exitance/solve/distant_cast.h"
#include "exitance/solve/luminaire_light.h"

namespace exitance {

std::vector<FaceId> emitters_of(const Radiosity& radiosity) {
    const Mesh& mesh = radiosity.mesh;
    std::vector<FaceId> emitters;
    std::vector<double> flux(mesh.faces().size(), 0.0);
    for (std::size_t f = 0; f < mesh.faces().size(); ++f) {
        const Face& face = mesh.faces()[f];
        if (!radiosity.emits(face)) continue;
        const auto corners = mesh.corners(face);
        flux[f] = area({corners.data(), face.count}) *
                  static_cast<double>(radiosity.columns.luminance(radiosity.emitted(face)));
        emitters.push_back(FaceId(f));
    }
    std::stable_sort(emitters.begin(), emitters.end(),
                     [&](FaceId a, FaceId b) { return flux[a.index()] > flux[b.index()]; });
    return emitters;
}

std::uint64_t cast_emission(const Radiosity& radiosity, std::span<const FaceId> emitters,
                            const Receivers& receivers, std::span<const std::uint32_t> which,
                            float tolerance, const ColumnOptions& options, Received& received) {
    std::uint64_t rays = 0;
    for (const FaceId face : emitters)
        rays += cast_light(radiosity.caster, emission_of(radiosity, face), receivers, which,
                           tolerance, options, radiosity.columns.stride, received);
    rays += cast_luminaires(radiosity, receivers, which, tolerance, options, received);
    rays += cast_suns(radiosity, receivers, which, tolerance, options, received);
    received.note_seen();
    // The sky has no sharp shadows, and indoors it would hide what lamps and sun show of theirs.
    rays += cast_skies(radiosity, receivers, which, tolerance, options, received);
    return rays;
}

}  // namespace exitance
