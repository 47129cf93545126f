// SPDX-License-Identifier: Apache-2.0
// Two passes: a rough balance of the whole scene on stored ray hits, then one gathering step at the
// vertices that people see (final gather, Reichert 1992), on a mesh that is refined for it. What a
// vertex gets straight from lamps, sun and sky is evaluated apart, exactly.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "exitance/formfactor/obstacles.h"
#include "exitance/mesh/field.h"
#include "exitance/solve/cast_light.h"
#include "exitance/solve/importance.h"
#include "exitance/solve/indirect.h"
#include "exitance/solve/lamps.h"
#include "exitance/solve/memory.h"
#include "exitance/solve/radiosity.h"
#include "exitance/solve/reflected_light.h"
#include "exitance/solve/solver.h"
#include "exitance/transport/column.h"

namespace exitance {

struct GatheringOptions {
    double error = 0.02;     ///< RMS error of irradiance relative to its mean to aim at
    double min_area = 1e-4;  ///< elements are not divided below this area [m²]
    bool adaptive = true;
    bool merge = true;  ///< elements that the light does not need
    /// Begin with complete light that is as rough as it may be: somebody waits for it.
    bool sketch = false;
    ColumnOptions column{};
    /// If there: the error is aimed at where somebody looks. Outlives the solver.
    const Importance* importance = nullptr;
    std::function<bool()> interrupted{};  ///< asked during long steps: true ends them
    const MemoryPlan* memory = nullptr;   ///< if there: what may be taken. Outlives the solver.
};

class Gathering final : public Solver {
  public:
    /// `radiosity` outlives the solver.
    Gathering(Radiosity& radiosity, const GatheringOptions& options);

    /// Maybe a sketch; direct light and its mesh; the rough balance; then one level of the
    /// quadtrees a step. From the sketch or else the balance on the vertices have complete light.
    bool step() override;
    /// Share of the work left, roughly: 1 until there is light.
    double unshot() const override;
    double enough() const override { return 0; }
    double next_shot() const override { return unshot(); }
    Progress progress() const override;

    /// To be called where run() ended early: vertices that wait for a gather are interpolated; if
    /// there is no complete light yet, it is sketched.
    void finish();
    /// Whether the vertices have complete light.
    bool has_light() const { return indirect_.has_value(); }
    /// Begins again on the mesh that there is, for a smaller error.
    void demand(double error, double min_area);
    std::uint64_t rays() const { return rays_; }
    std::size_t bytes() const;
    /// Whether elements stay undivided since memory has ended.
    bool is_full() const { return full_; }
    /// Of each patch in the last balance, if there was no memory for more.
    std::optional<std::uint32_t> scarce_patch_rays() const;

  private:
    enum class Phase { sketch, direct, balance, gather, merge, done };

    void sketch();
    void light_directly();
    void strike_balance();
    void balance_patches(double error, const std::function<bool()>& interrupted);
    void combine();
    void merge();
    /// Direct light of the vertices that have not got any yet.
    void complete_direct();
    std::uint64_t cast_direct(const Receivers& receivers, Received& received) const;
    void weigh();
    /// Luminance of irradiance that may be wrong.
    float tolerance() const;
    float patch_area() const;
    float min_area() const { return static_cast<float>(options_.min_area * lit_share_); }

    Radiosity& radiosity_;
    GatheringOptions options_;
    Phase phase_ = Phase::direct;
    Lamps lamps_;
    std::optional<Obstacles> obstacles_;  ///< if the scene is one of few polygons
    std::optional<ReflectedLight> reflected_;
    std::optional<IndirectLight> indirect_;
    VertexField direct_;  ///< D, of the first vertices, as far as it is known
    std::vector<float> direct_variance_;
    std::vector<float> of_direct_light_;  ///< importance per patch, or empty
    double mean_irradiance_ = 0, lit_share_ = 1;
    std::uint64_t rays_ = 0;
    int level_ = 0;
    bool thorough_ = true;  ///< elements have not been looked at yet
    bool full_ = false;
};

}  // namespace exitance
