// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/shooting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

// Of the error asked for, how much the light that is never shot may take: it is a bias, and adds
// linearly to what meshing and sampling leave.
constexpr double unshot_share = 0.15;

}  // namespace

Shooting::Shooting(Radiosity& radiosity, const ShootingOptions& options)
    : radiosity_(radiosity), options_(options) {
    const Mesh& mesh = radiosity_.mesh;
    std::vector<double> flux(mesh.faces().size(), 0.0);
    for (std::size_t f = 0; f < mesh.faces().size(); ++f) {
        const Face& face = mesh.faces()[f];
        if (!radiosity_.emits(face)) continue;
        const auto corners = mesh.corners(face);
        flux[f] = area({corners.data(), face.count}) *
                  static_cast<double>(radiosity_.columns.luminance(radiosity_.emitted(face)));
        emitters_.push_back(FaceId(f));
    }
    std::stable_sort(emitters_.begin(), emitters_.end(),
                     [&](FaceId a, FaceId b) { return flux[a.index()] > flux[b.index()]; });
    patch_shot_.assign(mesh.patches().size(), 0.0f);
    patch_unshot_.assign(mesh.patches().size(), 0.0f);
    const std::size_t stride = radiosity_.columns.stride;
    shot_flux_.assign(stride, 0.0);
    rho_area_.assign(stride, 0.0);
    for (const Patch& patch : mesh.patches()) {
        const auto rho = radiosity_.rho(mesh[patch.face]);
        const auto a = static_cast<float>(patch.area);
        for (std::size_t c = 0; c < stride; ++c) rho_area_[c] += patch.area * double(rho[c]);
        const Polygon& polygon = radiosity_.scene.polygons[mesh[patch.face].polygon.index()];
        patch_rho_.push_back(
            a * static_cast<float>(luminance(radiosity_.scene.material(polygon).reflectance)));
    }
    // Before anything is lit: what an even distribution of the emission would give.
    mean_irradiance_ = radiosity_.area() > 0 ? radiosity_.emitted_flux() / radiosity_.area() : 0.0;
}

bool Shooting::step() {
    if (!emitted_) {
        shoot_emission();
        emitted_ = true;
        return true;
    }
    const auto [patch, moved] = brightest();
    if (moved <= 0) return false;
    // Overshooting (Feda & Purgathofer 1992): a patch sends along what it will reflect of the
    // ambient light; what arrives later and was already sent makes its unshot light negative, and
    // is settled.
    shoot_patch(PatchId(patch), options_.overshoot
                                    ? ambient_per_column()
                                    : std::vector<float>(radiosity_.columns.stride, 0.0f));
    return true;
}

Shooting::Brightest Shooting::brightest() const {
    const auto spread = options_.overshoot ? static_cast<float>(ambient()) : 0.0f;
    Brightest best;
    for (std::size_t p = 0; p < patch_unshot_.size(); ++p) {
        const float moved = std::abs(patch_unshot_[p] + spread * patch_rho_[p]);
        if (moved > best.moved) best = {p, moved};
    }
    return best;
}

std::uint64_t Shooting::emit_to(const Receivers& receivers, Received& received,
                                std::size_t emitters) {
    std::vector<std::uint32_t> which(receivers.size());
    std::iota(which.begin(), which.end(), 0u);
    std::uint64_t rays = 0;
    for (std::size_t e = 0; e < emitters; ++e)
        rays += cast_light(radiosity_.caster, emission_of(radiosity_, emitters_[e]), receivers,
                           which, tolerance(), options_.column, radiosity_.columns.stride, received);
    return rays;
}

// All lamps together are one shooter: an element must carry the sum of their light, and new
// vertices get all of it evaluated again, never interpolated.
void Shooting::shoot_emission() {
    received_.reset(radiosity_.receivers.size(), radiosity_.columns.stride);
    rays_ += emit_to(radiosity_.receivers, received_, emitters_.size());
    shots_ += emitters_.size();
    // Now the level of light is known; before the bounces it is a 1/(1-ρ)-th of what it will be.
    deliver(received_);
    find_unshot();
    if (options_.adaptive && tolerance() > 0) {
        const std::size_t before = radiosity_.receivers.size();
        rays_ += refine(
            radiosity_, refine_options(true),
            [&](const Receivers& points, Received& lit) {
                return emit_to(points, lit, emitters_.size());
            },
            false, received_);
        for (std::size_t v = before; v < radiosity_.receivers.size(); ++v)
            if (radiosity_.exposed[v])
                radiosity_.receive(VertexId(v), received_.row(v, radiosity_.columns.stride));
    }
    find_unshot();
}

void Shooting::shoot_patch(PatchId patch, const std::vector<float>& ambient) {
    const LightSource source = unshot_of(radiosity_, patch, ambient);
    const std::size_t stride = radiosity_.columns.stride;
    const auto illuminate = [&](const Receivers& points, Received& lit) {
        if (everyone_.size() < points.size()) {
            everyone_.resize(points.size());
            std::iota(everyone_.begin(), everyone_.end(), 0u);
        }
        return cast_light(radiosity_.caster, source, points,
                          std::span(everyone_).first(points.size()), tolerance(), options_.column,
                          stride, lit);
    };
    received_.reset(radiosity_.receivers.size(), stride);
    rays_ += illuminate(radiosity_.receivers, received_);
    ++shots_;

    // What was shot is no longer unshot; children made below inherit their parent's record.
    const auto record = [&] {
        const auto visit = [&](const auto& self, ElementId id, std::size_t at) -> void {
            const Element& element = radiosity_.mesh[id];
            if (source.nodes[at].first_child == 0) {
                for (std::size_t c = 0; c < stride; ++c)
                    radiosity_.shot[id][c] += source.exitance[at * stride + c];
                return;
            }
            for (std::size_t k = 0; k < 4; ++k)
                self(self, ElementId(element.first_child.index() + k),
                     source.nodes[at].first_child + k);
        };
        visit(visit, radiosity_.mesh[patch].root, 0);
        patch_shot_[patch.index()] += source.nodes[0].luminance;
        for (std::size_t c = 0; c < stride; ++c)
            shot_flux_[c] += radiosity_.mesh[patch].area * double(source.exitance[c]);
    };
    record();
    if (options_.adaptive)
        rays_ += refine(radiosity_, refine_options(false), illuminate, true, received_);
    deliver(received_);
    find_unshot();
}

void Shooting::deliver(const Received& received) {
    const std::size_t stride = radiosity_.columns.stride;
    parallel_for(received.light.size(), [&](std::size_t v) {
        if (radiosity_.exposed[v] && received.unblocked[v] != 0)
            radiosity_.receive(VertexId(v), received.row(v, stride));
    });
    weigh_patches();
}

void Shooting::weigh_patches() {
    const Mesh& mesh = radiosity_.mesh;
    if (weighed_elements_ == mesh.elements().size()) return;
    weighed_elements_ = mesh.elements().size();
    weight_begin_.assign(1, 0);
    weight_vertex_.clear();
    weight_.clear();
    vertex_weight_.assign(mesh.vertices().size(), 0.0f);
    for (const Patch& patch : mesh.patches()) {
        mesh.for_leaves(patch.root, [&](ElementId id) {
            const Element& e = mesh[id];
            for (const VertexId v : e.corners()) {
                if (!radiosity_.exposed[v.index()]) continue;
                weight_vertex_.push_back(v.value);
                weight_.push_back(e.area / static_cast<float>(e.count));
                vertex_weight_[v.index()] += weight_.back();
            }
        });
        weight_begin_.push_back(static_cast<std::uint32_t>(weight_.size()));
    }
    received_area_ = std::accumulate(vertex_weight_.begin(), vertex_weight_.end(), 0.0);
}

namespace {

struct FluxSums {
    std::vector<double> reflected;
    double received = 0;

    FluxSums& operator+=(const FluxSums& other) {
        reflected.resize(std::max(reflected.size(), other.reflected.size()), 0.0);
        for (std::size_t c = 0; c < other.reflected.size(); ++c)
            reflected[c] += other.reflected[c];
        received += other.received;
        return *this;
    }
};

}  // namespace

void Shooting::find_unshot() {
    weigh_patches();
    unshot_flux_ = parallel_sum<double>(
        patch_unshot_.size(),
        [&](std::size_t begin, std::size_t end) {
            double sum = 0;
            for (std::size_t p = begin; p < end; ++p) {
                float reflected = 0;
                for (std::uint32_t k = weight_begin_[p]; k < weight_begin_[p + 1]; ++k)
                    reflected += weight_[k] * radiosity_.reflected[weight_vertex_[k]];
                const auto area = static_cast<float>(radiosity_.mesh.patches()[p].area);
                patch_unshot_[p] = reflected - patch_shot_[p] * area;
                sum += static_cast<double>(std::abs(patch_unshot_[p]));
            }
            return sum;
        },
        256);
    const std::size_t stride = radiosity_.columns.stride;
    FluxSums sums = parallel_sum<FluxSums>(vertex_weight_.size(), [&](std::size_t begin,
                                                                      std::size_t end) {
        FluxSums block{std::vector<double>(stride, 0.0)};
        std::vector<float> row(stride, 0.0f);
        for (std::size_t v = begin; v < end; ++v) {
            const auto H = radiosity_.irradiance[VertexId(v)];
            const auto rho = radiosity_.rho(VertexId(v));
            const float w = vertex_weight_[v];
            for (std::size_t c = 0; c < stride; ++c) {
                block.reflected[c] += static_cast<double>(w * rho[c] * H[c]);
                row[c] += w * H[c];
            }
        }
        block.received = static_cast<double>(radiosity_.columns.luminance(row));
        return block;
    });
    reflected_flux_ = sums.reflected;
    reflected_flux_.resize(stride, 0.0);
    received_flux_ = sums.received;
    if (received_area_ > 0)
        mean_irradiance_ = received_flux_ / received_area_ + std::max(0.0, ambient());
}

double Shooting::ambient() const {
    double sum = 0;
    for (const float u : patch_unshot_) sum += static_cast<double>(u);
    return radiosity_.area() > 0
               ? sum / radiosity_.area() / (1.0 - radiosity_.mean_reflectance())
               : 0.0;
}

std::vector<float> Shooting::ambient_per_column() const {
    std::vector<float> row(radiosity_.columns.stride, 0.0f);
    for (std::size_t c = 0; c < radiosity_.columns.count; ++c)
        row[c] = static_cast<float>((reflected_flux_[c] - shot_flux_[c]) /
                                    (radiosity_.area() - rho_area_[c]));
    return row;
}

float Shooting::tolerance() const {
    return static_cast<float>(std::max(options_.error * mean_irradiance_, 1e-30));
}

RefineOptions Shooting::refine_options(bool thorough) const {
    // A patch is one of many whose errors add up along a wall.
    const float share = thorough ? 1.0f : 0.25f;
    return {share * tolerance(), static_cast<float>(options_.min_area), thorough};
}

double Shooting::unshot() const {
    if (!emitted_) return 1.0;
    return radiosity_.emitted_flux() > 0 ? unshot_flux_ / radiosity_.emitted_flux() : 0.0;
}

double Shooting::enough() const {
    // Unshot flux u adds u / (1-ρ) / A to the irradiance in the end.
    if (radiosity_.emitted_flux() <= 0) return 0.0;
    return unshot_share * options_.error * mean_irradiance_ * radiosity_.area() *
           (1.0 - radiosity_.mean_reflectance()) / radiosity_.emitted_flux();
}

double Shooting::next_shot() const {
    if (!emitted_) return 1.0;
    const double flux = radiosity_.emitted_flux();
    return flux > 0 ? static_cast<double>(brightest().moved) / flux : 0.0;
}

Progress Shooting::progress() const {
    Progress out;
    out.phase = emitted_ ? "shooting" : "direct";
    out.fraction_left = unshot();
    out.shots = shots_;
    out.rays = rays_;
    out.vertices = radiosity_.receivers.size();
    return out;
}

}  // namespace exitance
