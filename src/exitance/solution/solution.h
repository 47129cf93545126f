// SPDX-License-Identifier: Apache-2.0
// The view-independent answer: irradiance at the vertices of a conforming triangulation, per light
// group and band, with all that is needed to evaluate it again.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/mesh/field.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/scene.h"
#include "exitance/solve/solver.h"

namespace exitance {

/// Where the light went, summed over all columns weighted by luminance [flux_unit of the scene].
struct EnergyBalance {
    double emitted = 0;
    double absorbed = 0;         ///< by front sides: (1 − ρ) E over the mesh
    double absorbed_behind = 0;  ///< by the black backs of one-sided surfaces, by black lamps
    double escaped = 0;          ///< left the scene
    double unshot = 0;           ///< still to be distributed when the solver stopped

    /// (emitted − all the rest) / emitted; 0 if nothing is emitted.
    double imbalance() const {
        const double rest = emitted - absorbed - absorbed_behind - escaped - unshot;
        return emitted > 0 ? rest / emitted : 0;
    }
};

/// RMS error of irradiance divided by mean irradiance, from held-out points.
struct ErrorEstimate {
    double rms = 0;         ///< relative: 0.02 = 2 %
    double confidence = 0;  ///< standard error of `rms`
    std::uint32_t points = 0;
};

/// By name, what a solution was refined for: elsewhere it is rough.
struct RefinedFor {
    std::optional<std::string> camera, grid;
};

/// Triangles [first_triangle, first_triangle + triangles) with one material.
struct SolutionPart {
    std::string name;  ///< surface name
    std::uint32_t material = 0;
    std::uint32_t group = 0;  ///< light group of its emission, if it emits
    std::uint32_t first_triangle = 0, triangles = 0;
};

/// A one-sided emitting polygon of the input, for exact direct light in later gathers.
struct Emitter {
    std::array<Vec3, 4> corners;
    std::uint32_t corner_count = 0;
    std::uint32_t part = 0;  ///< its material and group
    Spectrum exitance{};     ///< mean of a patterned material here; empty = its material's
};

/// A luminaire of the input and the light group that it shines in.
struct SolutionLuminaire {
    Luminaire luminaire;
    std::uint32_t group = 0;
};

/// Sun or sky of the input and the light group that it shines in.
struct SolutionDistantLight {
    DistantLight light;
    std::uint32_t group = 0;
};

struct Solution {
    std::string title;
    Quantity quantity = Quantity::unitless;
    std::vector<std::string> bands{"R", "G", "B"};
    Vec3 up{0, 1, 0};
    std::vector<LightGroup> groups;

    std::vector<Vec3f> positions;  ///< per vertex [m]
    std::vector<Vec3f> normals;    ///< per vertex, unit
    /// Per vertex; empty if no material is patterned.
    std::vector<TextureCoordinates> texture_coordinates{};
    VertexField irradiance;  ///< rows: vertices; columns: groups × bands [irradiance_unit]
    /// Per vertex while it is being solved, else empty: luminance of exitance that is still to be
    /// sent on (solve/unshot.h) [exitance_unit]. Files carry it for those who look on; reading
    /// drops it.
    std::vector<float> unshot{};
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from the lit side
    std::vector<SolutionPart> parts;                      ///< cover `triangles` in order
    std::vector<Material> materials;
    std::vector<Emitter> emitters;
    std::vector<SolutionLuminaire> luminaires;
    std::vector<SolutionDistantLight> distant;  ///< sun and sky
    std::vector<LightScene> light_scenes;       ///< named settings of the groups' weights

    std::vector<Camera> cameras;
    std::vector<SensorGrid> grids;

    EnergyBalance energy;
    std::optional<RefinedFor> refined_for;  ///< nothing: all places alike, view-independent
    std::optional<ErrorEstimate> error;
    Ended ended = Ended::converged;              ///< what ended the work
    std::map<std::string, std::string> options;  ///< as used, for reproduction
    std::map<std::string, double> counters;      ///< shots, rays, vertices …
    std::string scene_digest;                    ///< hexadecimal

    std::size_t columns() const { return groups.size() * bands.size(); }
    /// Of values per column: all groups by their weights, all bands as the eye weighs them.
    double luminance(std::span<const double> values) const;

    /// Exitance B = E + ρ H, of a pattern's means, in one column of vertex `vertex` seen as part of
    /// `part`.
    float exitance(std::size_t vertex, const SolutionPart& part, std::size_t column) const;
    /// The same for all columns, into `out` [columns()].
    void exitance(std::size_t vertex, const SolutionPart& part, std::span<float> out) const;
};

}  // namespace exitance
