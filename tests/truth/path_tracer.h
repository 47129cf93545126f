// SPDX-License-Identifier: Apache-2.0
// Brute-force irradiance of diffuse scenes: the truth that every method is judged by. It shares
// with the solvers nothing but the scene, the ray caster and the random numbers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/scene/groups.h"
#include "exitance/scene/scene.h"
#include "exitance/visibility/ray_caster.h"

namespace exitance::truth {

/// Where irradiance is wanted, on the side of the unit `normal`.
struct Receiver {
    Vec3 position, normal;
    Vec3 u{}, v{};  ///< zero: at `position`; else the mean over the texel position ± u/2 ± v/2
};

/// Receivers at the sample points of a grid, row by row from v = 0.
std::vector<Receiver> centres_of(const SensorGrid& grid);
/// The texels of a grid, for means over their areas, in the same order.
std::vector<Receiver> texels_of(const SensorGrid& grid);

/// Paths per receiver = replicates × samples. On the 2 × 64 × 64 grid points of the Cornell box
/// 1024 paths leave a standard error of 1.25 % of the mean irradiance (4096: 0.6 %, 16384: 0.3 %)
/// and take 5 s (20 s, 80 s) on two 2 GHz cores. The spread of the replicates, each an independent
/// randomisation of a stratified set, is what the standard error comes from.
struct Effort {
    std::uint32_t samples = 1024;   ///< per replicate, a power of two
    std::uint32_t replicates = 16;  ///< at least 2
    std::uint64_t seed = 0;
};

/// One row per receiver, one column per (light group × band): column = group · bands + band.
struct Estimate {
    std::size_t columns = 0;
    std::vector<double> mean;            ///< irradiance [irradiance_unit of the scene]
    std::vector<double> standard_error;  ///< of `mean`
    std::uint64_t paths = 0, rays = 0;

    double at(std::size_t receiver, std::size_t column = 0) const {
        return mean[receiver * columns + column];
    }
    double error_at(std::size_t receiver, std::size_t column = 0) const {
        return standard_error[receiver * columns + column];
    }
    /// Root mean square over the receivers of the standard error of one column.
    double rms_error(std::size_t column) const;
    /// Mean over the receivers of one column.
    double average(std::size_t column) const;
};

/// Unbiased: cosine-distributed paths, at every vertex one point of an emitter chosen by flux,
/// both combined by the balance heuristic (Veach & Guibas 1995), and one of a luminaire, which no
/// direction hits, and of every sun; sky where a path leaves; clear glass weakens what goes
/// straight through it, and reflects nothing; Russian roulette for faint paths.
/// One-sided surfaces reflect and emit from the front only; their backs are black. The result does
/// not depend on the number of threads.
class PathTracer {
  public:
    /// Emitting quadrilaterals must be planar and convex.
    explicit PathTracer(const Scene& scene, Grouping grouping = Grouping::none);

    Estimate irradiance(std::span<const Receiver> receivers, const Effort& effort = {}) const;

    std::size_t columns() const { return groups_.groups.size() * bands_; }
    const LightGroups& groups() const { return groups_; }

  private:
    struct Face {
        Vec3 normal;
        std::uint32_t material = 0, group = 0;
        double density = 0;  ///< probability per area that an emitter sample falls here [1/m²]
    };
    struct Emitter {
        Vec3 corner, edge1, edge2;
        std::uint32_t face = 0;
        double cumulative = 0;  ///< probability that this or an earlier triangle is chosen
    };
    /// A luminaire with the triangles of its opening; none if it is a point or a line.
    struct Lamp {
        struct Piece {
            Vec3 corner, edge1, edge2, normal;
            double cumulative = 0;  ///< area of this and earlier pieces [m²]
        };
        Luminaire luminaire;
        std::vector<Piece> pieces;
        std::uint32_t group = 0;
        double cumulative = 0;  ///< probability that this or an earlier lamp is chosen
    };
    struct Walk;

    void add_lamps(const Scene& scene);
    void sample_suns(Walk& walk, std::span<double> sums) const;
    double through(const Vec3& from, const Vec3& way, double far) const;
    void sample_lamps(Walk& walk, std::span<double> sums) const;
    void sample_lights(Walk& walk, std::span<double> sums) const;
    void step(Walk& walk, std::span<double> sums) const;
    void add_emission(const Face& face, bool front, double facing, double r2,
                      std::span<const double> weight, std::span<double> sums) const;

    std::size_t bands_;
    LightGroups groups_;
    std::vector<Material> materials_;
    std::vector<Face> faces_;
    std::vector<Emitter> emitters_;
    std::vector<Lamp> lamps_;
    std::vector<DistantLight> distant_;
    bool glass_ = false;
    RayCaster caster_;
};

}  // namespace exitance::truth
