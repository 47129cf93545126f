// SPDX-License-Identifier: Apache-2.0
// A luminaire as points receive light from it: its far-field intensity I(ω), emitted by the surface
// of its luminous opening. A place q of the opening with normal n sends along ω the share
// (n·ω)⁺ / A(ω) of I, where A(ω) = ∫ (n·ω)⁺ dA is what the opening shows in that direction. So the
// shares add up to the far field and to the flux, and the opening looks evenly bright from afar.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/scene/luminaire.h"

namespace exitance {

class LuminaireSource {
  public:
    explicit LuminaireSource(const Luminaire& luminaire);

    /// Irradiance at `point` facing `normal` (unit) if nothing is in the way, for a colour of 1
    /// [irradiance_unit].
    double irradiance(const Vec3& point, const Vec3& normal) const;

    /// A place of the opening for a receiver, and what it is there for.
    struct Sample {
        Vec3 place, normal;  ///< normal: to which side light leaves
        double weight = 0;   ///< of this place in the irradiance / density of the sample
    };
    /// How a receiver's samples are shared among the facets: in proportion to what they show of
    /// themselves.
    struct View {
        std::vector<double> cumulative;  ///< per facet; empty for a point
    };
    void look(const Vec3& point, View& view) const;
    /// From (u, v) in [0, 1)² and what look() found for the point.
    Sample sample(const View& view, const Vec3& point, const Vec3& normal, double u,
                  double v) const;
    /// Places in proportion to what the opening shows along `direction`, unit.
    Sample sample_along(const Vec3& direction, double u, double v) const;

    bool is_point() const { return facets_.empty(); }
    const Luminaire& luminaire() const { return luminaire_; }

  private:
    struct Facet {
        Vec3 corner, u, v, uv;  ///< q = corner + s u + t v + s t uv over the unit square
        Vec3 normal, middle;
        double area = 0;
        Vec3 at(double s, double t) const { return corner + u * s + v * t + uv * (s * t); }
        /// |dq/ds × dq/dt|; of a line |dq/ds|.
        double jacobian(double s, double t) const;
        bool is_line = false;
    };
    /// (n·ω)⁺ / A(ω).
    double share(const Facet& facet, const Vec3& direction) const;
    /// Irradiance from q, per area of the facet.
    double kernel(const Facet& facet, const Vec3& q, const Vec3& point, const Vec3& normal) const;
    double integrate(const Facet& facet, const Vec3& point, const Vec3& normal, double s0,
                     double s1, double t0, double t1, int depth) const;

    Luminaire luminaire_;
    double near_share_ = 0;  ///< cells may be this large for their distance
    std::vector<Facet> facets_;
    struct Plane {
        Vec3 normal;
        double area = 0;
    };
    std::vector<Plane> planes_;  ///< areas of the facets by their directions
};

}  // namespace exitance
