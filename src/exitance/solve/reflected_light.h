// SPDX-License-Identifier: Apache-2.0
// The reflected light of a scene as points gather it: R = ρ (D + F R) between patches, F from the
// stored hits of a few rays each; inside them D, and with it R, as fine as the mesh, and F R
// linear.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "exitance/mesh/field.h"
#include "exitance/solve/cast_light.h"
#include "exitance/solve/lamps.h"
#include "exitance/solve/patch_cells.h"
#include "exitance/solve/patch_slopes.h"
#include "exitance/solve/radiosity.h"
#include "exitance/transport/element_caster.h"

namespace exitance {

struct ReflectedLightOptions {
    double error = 0.02;     ///< RMS error of irradiance relative to its mean that is aimed at
    ColumnOptions column{};  ///< of what is bright enough to be seen as lamps are
    std::function<bool()> interrupted{};
    std::uint32_t most_rays = 1024;  ///< of a patch in the balance
    /// R in cells takes no more than this; where rows are long, for many groups of light, it may.
    std::size_t most_cell_bytes = std::size_t{256} << 20;
};

/// What a point sees beside light.
struct Surroundings {
    float backs = 0;             ///< share of the rays that met the back of a one-sided polygon
    float inverse_distance = 0;  ///< mean of 1 / distance over the rays [1/m]
};

class ReflectedLight {
  public:
    /// Strikes the balance: `radiosity` holds direct light at its vertices, and outlives this.
    /// `shot` of its elements becomes R.
    ReflectedLight(Radiosity& radiosity, const ReflectedLightOptions& options);

    /// Irradiance F R of each patch.
    const RowField& irradiance() const { return irradiance_; }

    /// How many rays from a point on this patch miss by no more than `deviation` (luminance of
    /// irradiance, standard deviation): a power of two.
    std::uint32_t rays_for(PatchId patch, float deviation) const;
    /// What that many rays miss by.
    float deviation(PatchId patch, std::uint32_t rays) const;

    /// Finds out by trial on some patches how many rays the scene needs for this deviation, before
    /// the two above are asked.
    void calibrate(float deviation);

    /// Adds the reflected light that rays[i] rays from receiver i find, and the variance that their
    /// two halves show, to `received`; returns rays cast. `around`: one per receiver.
    std::uint64_t gather(const Receivers& receivers, std::span<const std::uint32_t> rays,
                         Received& received, std::span<Surroundings> around) const;

    std::uint64_t rays() const { return rays_; }
    /// Cast from each patch for the balance, and whether the error asked for more of them.
    std::uint32_t patch_rays() const { return caster_.rays(); }
    bool lacks_rays() const;
    std::size_t bytes() const;

  private:
    void balance();

    Radiosity& radiosity_;
    ReflectedLightOptions options_;
    ElementScene scene_;
    ElementRows rows_;
    PatchSlopes slopes_;
    PatchCells cells_;
    ElementCaster caster_;
    RowField irradiance_;  ///< F R of patches
    std::vector<float>
        spread_;            ///< per patch: standard deviation of the luminance of R that it sees
    float unevenness_ = 1;  ///< deviation found by trial, relative to what the law says
    std::optional<Lamps> bright_;  ///< taken out of the cells
    float tolerance_ = 1;          ///< luminance of irradiance that gathers may miss
    std::uint64_t rays_ = 0;
};

}  // namespace exitance
