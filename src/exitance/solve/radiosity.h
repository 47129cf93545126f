// SPDX-License-Identifier: Apache-2.0
// What every solver works on: B = E + ρ H, H = F B. The mesh, the irradiance H of its vertices, and
// how much of each element's reflected exitance ρ H has been shot.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/mesh/field.h"
#include "exitance/mesh/mesh.h"
#include "exitance/scene/groups.h"
#include "exitance/scene/scene.h"
#include "exitance/transport/luminaire_source.h"
#include "exitance/transport/sky_source.h"
#include "exitance/visibility/place_owners.h"
#include "exitance/visibility/ray_caster.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// Columns of a field: group · bands + band. Rows of columns are padded with zeros to `stride`.
struct Columns {
    std::size_t groups = 1, bands = 3, count = 3, stride = 4;
    std::vector<float> weight;  ///< per column: group weight × luminance weight of the band

    Columns(const std::vector<LightGroup>& light_groups, std::size_t band_count);
    /// Σ weight · row: the one number that adaptive decisions look at.
    float luminance(std::span<const float> row) const;
    /// Σ weight · |row|: how much light a signed row moves; what one column has too much of does
    /// not make up for what another lacks.
    float magnitude(std::span<const float> row) const;
};

class Radiosity {
  public:
    Radiosity(const Scene& scene, const LightGroups& groups, const MeshOptions& mesh_options);

    const Scene& scene;
    LightGroups groups;
    Columns columns;
    RayCaster caster;
    PlaceOwners owners;
    std::vector<LuminaireSource> luminaires;               ///< emit, and are not in the mesh
    std::vector<std::pair<std::size_t, SkySource>> skies;  ///< by their index in Scene::distant
    Mesh mesh;

    Receivers receivers;        ///< one per vertex
    std::vector<char> exposed;  ///< per vertex: open to the room (visibility/exposure.h)
    /// Per vertex: exposed, and not on a place that another polygon owns. The others receive light
    /// but send none: it is sent already, or covered.
    std::vector<char> sends;
    VertexField irradiance;       ///< H; rows of vertices that are not exposed stay zero
    std::vector<float> seen;      ///< per vertex: visible share of the lamps' light
    std::vector<float> variance;  ///< per vertex: of the luminance of H, from sampling visibility
    ElementField shot;            ///< per leaf: reflected exitance already shot
    bool emission_shot = false;

    /// Reflectance per column of the face's material.
    std::span<const float> rho(const Face& face) const;
    /// Reflectance per column of an element: of a textured face, the mean over the element.
    std::span<const float> rho(ElementId element) const;
    /// Emitted exitance per column, the mean over the face's polygon.
    std::span<const float> emitted(const Face& face) const;
    /// Whether reflectance varies over the face.
    bool textured(const Face& face) const;
    /// What a luminaire emits per column, for an intensity of 1: its colour in its group.
    std::span<const float> emitted_by_luminaire(std::size_t luminaire) const;
    /// Per column: the colour of a distant light in its group.
    std::span<const float> emitted_from_afar(std::size_t light) const;
    bool emits(const Face& face) const;

    /// Makes receivers, rows and exposure for vertices that the mesh has gained.
    void admit_new_vertices();
    /// H of `vertex` += what one shot brought.
    void receive(VertexId vertex, std::span<const float> row);

    /// Share of an element's corners that send, which stands for the share of its area.
    float open_share(const Element& element) const;
    /// Weights, summing to 1, that give the mean over the sending part of a leaf from vertices;
    /// empty if none sends. Four leaves of one parent are integrated together by Richardson's rule
    /// from theirs and the parent's corners (on a square Simpson's order of accuracy): the
    /// trapezoidal rule alone loses light, which is concave over most surfaces.
    struct Weight {
        VertexId vertex;
        float share;
    };
    void mean_weights(ElementId leaf, std::vector<Weight>& out) const;
    /// Mean irradiance of the sending part of an element.
    void mean_irradiance(ElementId leaf, std::span<float> out) const;
    /// ρ H of the sending part of an element.
    void reflected_exitance(ElementId leaf, std::span<float> out) const;

    double area() const { return area_; }
    /// Luminance-weighted emitted flux; of sun and sky what the mesh takes (solve/distant_flux.h).
    double emitted_flux() const { return emitted_flux_; }

    const std::vector<char>& two_sided() const { return two_sided_; }
    /// Per polygon: a lamp that reflects nothing. Nobody asks for the light that it receives: its
    /// mesh is not refined, and the balance counts what lands there by rays.
    const std::vector<char>& black_lamp() const { return black_lamp_; }

    /// A polygon of `face` as a source, with what covers it.
    Source source(const Face& face, const std::array<Vec3, 4>& corners) const;

    std::size_t bytes() const;

  private:
    std::vector<float> rho_;                   ///< material × stride
    std::vector<float> emitted_;               ///< surface × stride
    std::vector<float> emitted_by_luminaire_;  ///< luminaire × stride
    /// Row of `emitted_` of polygons whose emission varies; their surface's row serves the others.
    /// Empty if there are none.
    std::vector<std::uint32_t> emitted_of_polygon_;
    bool any_textured_ = false;
    ElementField rho_of_element_;        ///< filled for textured faces; no rows if there are none
    std::size_t textured_elements_ = 0;  ///< looked at for the above
    void find_rho_of_new_elements();
    void find_emission_of_textured_polygons();
    std::vector<float> emitted_from_afar_;  ///< distant light × stride
    std::vector<char> two_sided_, black_lamp_;
    double area_ = 0, emitted_flux_ = 0;
};

}  // namespace exitance
