// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/shooting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

// Of the error asked for, how much the light that is never shot may take: it is a bias, and adds
// linearly to what meshing and sampling leave.
constexpr double unshot_share = 0.15;
// The mesh is refined for all the light when this many times what may stay unshot is left: by then
// its pattern stands, and what the refinement changes is shot together with the rest.
constexpr double refine_at = 4;
// Relative error of sums in float, per root of their number of terms.
constexpr float sum_rounding = 4 * std::numeric_limits<float>::epsilon();

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
    if (options_.adaptive && !refined_ && unshot() <= refine_at * enough()) {
        refine_mesh();
        refined_ = true;
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
        // What a patch has received and shot are sums in float: below their rounding nothing is
        // left.
        const auto terms = static_cast<float>(weight_begin_[p + 1] - weight_begin_[p]);
        if (moved <= sum_rounding * (4 + std::sqrt(terms)) * std::abs(patch_shot_[p])) continue;
        if (moved > best.moved) best = {p, moved};
    }
    return best;
}

// Everything that has been shot so far, at any points: emission first, whose shadows are noted.
std::uint64_t Shooting::illuminate(const Receivers& receivers, Received& received) {
    std::vector<std::uint32_t> which(receivers.size());
    std::iota(which.begin(), which.end(), 0u);
    const auto cast = [&](const LightSource& source) {
        return cast_light(radiosity_.caster, source, receivers, which, tolerance(), options_.column,
                          radiosity_.columns.stride, received);
    };
    std::uint64_t rays = 0;
    for (const FaceId face : emitters_) rays += cast(emission_of(radiosity_, face));
    received.note_seen();
    for (std::size_t p = 0; p < patch_shot_.size(); ++p)
        if (patch_shot_[p] != 0) rays += cast(shot_of(radiosity_, PatchId(p)));
    return rays;
}

void Shooting::shoot_emission() {
    received_.reset(radiosity_.receivers.size(), radiosity_.columns.stride);
    rays_ += illuminate(radiosity_.receivers, received_);
    shots_ += emitters_.size();
    deliver(received_);
    radiosity_.seen = received_.seen;
    find_unshot();
    if (options_.adaptive) refine_mesh();
}

void Shooting::refine_mesh() {
    // As many elements as there are patches, each wrong by the tolerance, are wrong by it together.
    const double share = radiosity_.area() / static_cast<double>(radiosity_.mesh.patches().size());
    const RefineOptions options{tolerance(), static_cast<float>(share),
                                static_cast<float>(options_.min_area), !refined_,
                                options_.interrupted};
    rays_ += refine(radiosity_, options, [&](const Receivers& points, Received& lit) {
        return illuminate(points, lit);
    });
    find_unshot();
}

void Shooting::shoot_patch(PatchId patch, const std::vector<float>& ambient) {
    const LightSource source = unshot_of(radiosity_, patch, ambient);
    const std::size_t stride = radiosity_.columns.stride;
    received_.reset(radiosity_.receivers.size(), stride);
    for (std::size_t i = everyone_.size(); i < radiosity_.receivers.size(); ++i)
        everyone_.push_back(static_cast<std::uint32_t>(i));
    rays_ += cast_light(radiosity_.caster, source, radiosity_.receivers, everyone_, tolerance(),
                        options_.column, stride, received_);
    ++shots_;
    deliver(received_);

    // What was shot is no longer unshot.
    const auto record = [&](const auto& self, ElementId id, std::size_t at) -> void {
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
    record(record, radiosity_.mesh[patch].root, 0);
    const LightSource::Node& root = source.nodes[0];
    patch_shot_[patch.index()] += root.open_area * root.luminance;
    for (std::size_t c = 0; c < stride; ++c)
        shot_flux_[c] += double(root.open_area) * double(source.exitance[c]);
    find_unshot();
}

namespace {

struct FluxSums {
    std::vector<double> reflected;
    double received = 0;

    FluxSums& operator+=(const FluxSums& other) {
        reflected.resize(std::max(reflected.size(), other.reflected.size()), 0.0);
        for (std::size_t c = 0; c < other.reflected.size(); ++c) reflected[c] += other.reflected[c];
        received += other.received;
        return *this;
    }
};

}  // namespace

// Adds what a shot brought to the vertices, and to the sums that are kept of them.
void Shooting::deliver(const Received& received) {
    weigh_patches();
    const std::size_t stride = radiosity_.columns.stride;
    const FluxSums sums =
        parallel_sum<FluxSums>(received.light.size(), [&](std::size_t begin, std::size_t end) {
            FluxSums block{std::vector<double>(stride, 0.0)};
            std::vector<float> total(stride, 0.0f);
            for (std::size_t v = begin; v < end; ++v) {
                if (!radiosity_.exposed[v] || received.unblocked[v] == 0) continue;
                const auto row = received.row(v, stride);
                radiosity_.receive(VertexId(v), row);
                radiosity_.variance[v] += received.variance[v];
                add_flux(v, row, total, block.reflected);
            }
            block.received = static_cast<double>(radiosity_.columns.luminance(total));
            return block;
        });
    for (std::size_t c = 0; c < sums.reflected.size(); ++c) reflected_flux_[c] += sums.reflected[c];
    received_flux_ += sums.received;
}

void Shooting::add_flux(std::size_t vertex, std::span<const float> row, std::vector<float>& total,
                        std::vector<double>& reflected) const {
    const auto rho = radiosity_.rho(VertexId(vertex));
    const float w = vertex_weight_[vertex];
    for (std::size_t c = 0; c < row.size(); ++c) {
        reflected[c] += static_cast<double>(w * rho[c] * row[c]);
        total[c] += w * row[c];
    }
}

void Shooting::weigh_patches() {
    const Mesh& mesh = radiosity_.mesh;
    if (weighed_elements_ == mesh.elements().size()) return;
    weighed_elements_ = mesh.elements().size();
    weight_begin_.assign(1, 0);
    weight_vertex_.clear();
    weight_.clear();
    vertex_weight_.assign(mesh.vertices().size(), 0.0f);
    std::vector<Radiosity::Weight> mean;
    std::vector<std::pair<std::uint32_t, float>> sum;
    for (const Patch& patch : mesh.patches()) {
        sum.clear();
        mesh.for_leaves(patch.root, [&](ElementId id) {
            const float open = radiosity_.open_share(mesh[id]) * mesh[id].area;
            radiosity_.mean_weights(id, mean);
            for (const Radiosity::Weight& w : mean) sum.push_back({w.vertex.value, open * w.share});
        });
        std::stable_sort(sum.begin(), sum.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [vertex, area] : sum) {
            if (weight_vertex_.size() == weight_begin_.back() || weight_vertex_.back() != vertex) {
                weight_vertex_.push_back(vertex);
                weight_.push_back(0.0f);
            }
            weight_.back() += area;
            vertex_weight_[vertex] += area;
        }
        weight_begin_.push_back(static_cast<std::uint32_t>(weight_.size()));
    }
    std::fill(shot_flux_.begin(), shot_flux_.end(), 0.0);
    for (std::size_t p = 0; p < patch_shot_.size(); ++p) {
        patch_shot_[p] = 0;
        mesh.for_leaves(mesh.patches()[p].root, [&](ElementId id) {
            const auto shot = radiosity_.shot[id];
            const float open = radiosity_.open_share(mesh[id]) * mesh[id].area;
            patch_shot_[p] += open * radiosity_.columns.luminance(shot);
            for (std::size_t c = 0; c < shot.size(); ++c) shot_flux_[c] += double(open * shot[c]);
        });
    }
    // Of the light received so far:
    const std::size_t stride = radiosity_.columns.stride;
    reflected_flux_.assign(stride, 0.0);
    std::vector<float> total(stride, 0.0f);
    for (std::size_t v = 0; v < vertex_weight_.size(); ++v)
        add_flux(v, radiosity_.irradiance[VertexId(v)], total, reflected_flux_);
    received_flux_ = static_cast<double>(radiosity_.columns.luminance(total));
    received_area_ = std::accumulate(vertex_weight_.begin(), vertex_weight_.end(), 0.0);
}

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
                patch_unshot_[p] = reflected - patch_shot_[p];
                sum += static_cast<double>(std::abs(patch_unshot_[p]));
            }
            return sum;
        },
        256);
    if (received_area_ > 0)
        mean_irradiance_ = received_flux_ / received_area_ + std::max(0.0, ambient());
}

double Shooting::ambient() const {
    double sum = 0;
    for (const float u : patch_unshot_) sum += static_cast<double>(u);
    return radiosity_.area() > 0 ? sum / radiosity_.area() / (1.0 - radiosity_.mean_reflectance())
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

double Shooting::unshot() const {
    if (!emitted_) return 1.0;
    return radiosity_.emitted_flux() > 0 ? unshot_flux_ / radiosity_.emitted_flux() : 0.0;
}

double Shooting::enough() const {
    // Unshot flux u adds u / (1-ρ) / A to the irradiance in the end, most in the band that is
    // reflected most.
    const double rho = *std::max_element(rho_area_.begin(), rho_area_.end()) / radiosity_.area();
    if (radiosity_.emitted_flux() <= 0) return 0.0;
    return unshot_share * options_.error * mean_irradiance_ * radiosity_.area() * (1.0 - rho) /
           radiosity_.emitted_flux();
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
