// SPDX-License-Identifier: Apache-2.0
// Progressive refinement radiosity (Cohen, Chen, Wallace & Greenberg 1988): the patch with the most
// unshot light shoots to all vertices; vertices receive as Wallace, Elmquist & Haines 1989 do, but
// with the exact factor. In the terms of linear algebra this is Southwell's relaxation.
#pragma once

#include <functional>
#include <vector>

#include "exitance/solve/cast_light.h"
#include "exitance/solve/lamps.h"
#include "exitance/solve/refine.h"
#include "exitance/solve/solver.h"

namespace exitance {

struct ShootingOptions {
    double error = 0.02;  ///< RMS error of irradiance relative to its mean to aim at
    double min_area = 0;  ///< smallest element [m²]
    bool adaptive = true;
    bool overshoot = true;
    ColumnOptions column;
    /// Asked during long steps: true ends a refinement where it stands.
    std::function<bool()> interrupted{};
};

class Shooting final : public Solver {
  public:
    Shooting(Radiosity& radiosity, const ShootingOptions& options);

    /// The first step shoots the emission of the lamps and refines the mesh for it; then patches
    /// reflect, one a step; when little is left to shoot the mesh is refined once for all the
    /// light, and what that changed is shot in turn.
    bool step() override;
    double unshot() const override;
    double enough() const override;
    double next_shot() const override;
    Progress progress() const override;

    /// Luminance of irradiance far below the error asked for.
    float negligible() const { return 0.25f * tolerance(); }

    /// Asks for more: the mesh is refined for `error` down to `min_area`, and what that changes is
    /// shot.
    void demand(double error, double min_area);

    std::uint64_t shots() const { return shots_; }
    std::uint64_t rays() const { return rays_; }

    /// Ambient estimate of Cohen et al. 1988: irradiance that everything still unshot
    /// would add on average, per column of the field; falls to 0 as the solution converges.
    std::vector<float> ambient() const;

  private:
    void shoot_emission();
    void shoot_patch(PatchId patch, const std::vector<float>& ambient);
    std::uint64_t illuminate(const Receivers& receivers, Received& received);
    void refine_mesh();
    void deliver(const Received& received);
    struct Brightest {
        std::size_t patch = 0;
        float moved = 0;  ///< flux, Columns::magnitude
    };
    std::vector<float> overshoot() const;
    /// The patch whose shot moves most light.
    Brightest brightest() const;
    void weigh_patches();
    void weigh_textures();
    /// Reflectance per column of a patch, the mean over what is not covered.
    std::span<const float> mean_rho(std::size_t patch) const;
    /// Flux that a patch reflects of what it has `received`.
    void find_reflected(std::size_t patch, std::span<const float> received,
                        std::span<float> out) const;
    void find_unshot();
    float tolerance() const;

    Radiosity& radiosity_;
    ShootingOptions options_;
    Lamps lamps_;
    bool refined_ = false;

    // Reflected light of a patch as a weighted sum over vertices, rebuilt when the mesh changes.
    std::vector<std::uint32_t> weight_begin_, weight_vertex_;
    std::vector<float> weight_;
    std::size_t weighed_elements_ = 0;
    /// Of a patch whose reflectance varies: its weights, element by element.
    struct TexturedPatch {
        struct Term {
            VertexId vertex;
            ElementId element;
            float area;
        };
        std::vector<Term> terms{};
        std::vector<float> mean_rho{};  ///< per column; empty for other patches
    };
    std::vector<TexturedPatch> textured_;  ///< patches, or empty if there are none
    std::vector<float> patch_open_;        ///< area of each that receives and sends
    std::vector<float> patch_shot_;        ///< reflected flux already shot: patches × columns
    std::vector<float> patch_unshot_;      ///< the rest of the reflected flux, signed
    double unshot_flux_ = 0;               ///< Σ of its magnitudes
    std::vector<double> unshot_column_;    ///< Σ over the patches, signed
    std::vector<double> rho_area_;         ///< Σ A ρ per column, over the open area
    double open_area_ = 0;
    double lit_share_ = 1;        ///< of the open area that light is spread over
    double mean_irradiance_ = 0;  ///< luminance

    Received received_;
    std::vector<std::uint32_t> everyone_;
    std::uint64_t shots_ = 0, rays_ = 0;
};

}  // namespace exitance
