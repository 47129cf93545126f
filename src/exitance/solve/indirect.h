// SPDX-License-Identifier: Apache-2.0
// Reflected light at the vertices: gathered where it bends, interpolated where that is shown to be
// good enough.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "exitance/mesh/field.h"
#include "exitance/solve/cast_light.h"
#include "exitance/solve/radiosity.h"
#include "exitance/solve/reflected_light.h"

namespace exitance {

struct IndirectOptions {
    float tolerance = 0;   ///< irradiance (luminance) that may be wrong in an element of `area`
    float area = 1;        ///< [m²]; smaller elements may be wrong by more
    float min_area = 0;    ///< elements below this area stay [m²]
    bool adaptive = true;  ///< elements may be divided
    std::size_t most_vertices = SIZE_MAX;  ///< the mesh is not divided beyond these
    /// Per patch: what the tolerance is divided by, 0 = the patch keeps its light on average;
    /// empty: all alike.
    std::span<const float> shown{};
    std::function<bool()> interrupted{};
};

/// Goes down the quadtrees level by level. An element in whose middle a gather finds what its
/// corners say is smooth, and the vertices in it are interpolated; others go on with their
/// children, and leaves are divided. Direct light, which makes most of the vertices, has nothing to
/// say here.
class IndirectLight {
  public:
    /// All vertices begin with the irradiance of their patches. All but the numbers outlives this.
    IndirectLight(Radiosity& radiosity, ReflectedLight& source, const IndirectOptions& options);

    /// One level; false when nothing is left to do. Vertices that elements gain are interpolated
    /// until they are gathered.
    bool step();

    /// Interpolates whatever has not been gathered. Where interruption left corners without light
    /// of their own, that of the patches stays.
    void finish();

    /// Vertices that the mesh has gained otherwise have the irradiance of their patches.
    void admit_new_vertices();

    /// What may be wrong, once there is a first solution to tell it by.
    void set_tolerance(float tolerance, float min_area);

    VertexField irradiance;       ///< per vertex
    std::vector<float> variance;  ///< per vertex: of its luminance
    std::uint64_t rays() const { return rays_; }

  private:
    /// A place inside an element or on its sides that tells whether it is smooth.
    struct Test {
        FaceId face;
        std::array<std::int32_t, 2> place;
        std::uint32_t rays = 0;
        float deviation = 0;
    };
    /// What the corners of an element say of a place that is tested.
    struct Expected {
        ElementId element;
        std::uint32_t test = 0;
        float light = 0, variance = 0;
        float allowed = 0;    ///< departure of light
        bool middle = false;  ///< of a quad, as against on a side
    };
    struct Tests {
        Receivers points;
        std::vector<Test> at;  ///< one per point
        std::vector<Expected> expected;
    };
    void spread_patches(std::size_t first);
    void make_room();
    void know(VertexId v, std::span<const float> row, float deviation, float inverse_distance);
    bool gather_corners(const std::vector<ElementId>& elements);
    void sort_out(std::vector<ElementId>& tested, std::vector<ElementId>& rough);
    Tests tests_of(const std::vector<ElementId>& elements) const;
    bool worth_testing(const Element& element) const;
    bool touched(const Element& element) const;
    static bool fails(const Expected& expected, const Test& test, float found);
    void close(ElementId id, std::span<const float> middle);
    void divide(const std::vector<ElementId>& elements);
    void interpolate(const Element& whole, const std::array<std::int32_t, 2>& place, VertexId to);
    void interpolate_in(ElementId id, std::span<const float> bend);
    float light(VertexId v) const;
    float shown(PatchId patch) const;
    float base_tolerance(const Element& element) const;
    float tolerance(const Element& element) const;
    std::uint32_t rays_for(const Element& element) const;
    bool may_be_divided(const Element& element) const;

    Radiosity& radiosity_;
    ReflectedLight& source_;
    IndirectOptions options_;
    std::vector<ElementId> open_;  ///< to be looked at; their corners have light
    /// Smooth. In the middle of one that was tested light is above what its corners say by a row
    /// of `bends_`.
    struct Closed {
        ElementId element;
        std::uint32_t bend = none;
        static constexpr std::uint32_t none = 0xffffffffU;
    };
    std::vector<Closed> closed_;
    std::vector<float> bends_;             ///< rows of columns
    std::vector<char> known_;              ///< per vertex: gathered
    std::vector<float> inverse_distance_;  ///< per gathered vertex: mean over its rays [1/m]
    std::uint64_t rays_ = 0;
};

}  // namespace exitance
