// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/shooting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "exitance/run/parallel.h"
#include "exitance/solve/cast_emission.h"

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
    : radiosity_(radiosity), options_(options), lamps_(radiosity) {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    patch_shot_.assign(mesh.patches().size() * stride, 0.0f);
    patch_unshot_.assign(mesh.patches().size() * stride, 0.0f);
    unshot_column_.assign(stride, 0.0);
    rho_area_.assign(stride, 0.0);
    // Before anything is lit: what an even distribution of the emission would give.
    mean_irradiance_ = radiosity_.area() > 0 ? radiosity_.emitted_flux() / radiosity_.area() : 0.0;
}

bool Shooting::step() {
    if (!radiosity_.emission_shot) {
        shoot_emission();
        radiosity_.emission_shot = true;
        return true;
    }
    if (options_.adaptive && !refined_ && unshot() <= refine_at * enough()) {
        refine_mesh();
        refined_ = true;
        return true;
    }
    const auto [patch, moved] = brightest();
    if (moved <= 0) return false;
    shoot_patch(PatchId(patch), overshoot());
    return true;
}

// Overshooting (Feda & Purgathofer 1992): a patch sends along what it will reflect of the ambient
// light; what arrives later and was already sent makes its unshot light negative, and is settled.
std::vector<float> Shooting::overshoot() const {
    return options_.overshoot ? ambient() : std::vector<float>(radiosity_.columns.stride, 0.0f);
}

void Shooting::demand(double error, double min_area) {
    options_.error = error;
    options_.min_area = min_area;
    refined_ = false;
}

Shooting::Brightest Shooting::brightest() const {
    const Mesh& mesh = radiosity_.mesh;
    const Columns& columns = radiosity_.columns;
    const std::vector<float> spread = overshoot();
    std::vector<float> flux(columns.stride);
    Brightest best;
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        const auto rho = mean_rho(p);
        const float area = patch_open_[p];
        for (std::size_t c = 0; c < columns.stride; ++c)
            flux[c] = patch_unshot_[p * columns.stride + c] + spread[c] * rho[c] * area;
        const float moved = columns.magnitude(flux);
        if (moved <= best.moved) continue;
        // What a patch has received and shot are sums in float: below their rounding nothing is
        // left.
        const auto terms = static_cast<float>(weight_begin_[p + 1] - weight_begin_[p]);
        const float shot = columns.magnitude({&patch_shot_[p * columns.stride], columns.stride});
        if (moved > sum_rounding * (4 + std::sqrt(terms)) * shot) best = {p, moved};
    }
    return best;
}

// Everything that has been shot so far, at any points: emission first, whose shadows are noted.
std::uint64_t Shooting::illuminate(const Receivers& receivers, Received& received) {
    std::vector<std::uint32_t> which(receivers.size());
    std::iota(which.begin(), which.end(), 0u);
    std::uint64_t rays =
        cast_emission(radiosity_, lamps_, receivers, which, tolerance(), options_.column, received);
    const Columns& columns = radiosity_.columns;
    for (std::size_t p = 0; p < radiosity_.mesh.patches().size(); ++p)
        if (columns.magnitude({&patch_shot_[p * columns.stride], columns.stride}) > 0)
            rays += cast_light(radiosity_.caster, shot_of(radiosity_, PatchId(p)), receivers, which,
                               tolerance(), options_.column, columns.stride, received);
    return rays;
}

void Shooting::shoot_emission() {
    received_.reset(radiosity_.receivers.size(), radiosity_.columns.stride);
    rays_ += illuminate(radiosity_.receivers, received_);
    shots_ += lamps_.size() + radiosity_.scene.distant.size();
    deliver(received_);
    radiosity_.seen = received_.seen;
    find_unshot();
    if (options_.adaptive) refine_mesh();
}

void Shooting::refine_mesh() {
    // As many elements as there are patches, each wrong by the tolerance, are wrong by it together.
    const double share = radiosity_.area() / static_cast<double>(radiosity_.mesh.patches().size());
    RefineOptions options;
    options.tolerance = tolerance();
    options.area = static_cast<float>(share);
    options.min_area = static_cast<float>(options_.min_area * lit_share_);
    options.thorough = !refined_;
    options.interrupted = options_.interrupted;
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
    for (std::size_t c = 0; c < stride; ++c)
        patch_shot_[patch.index() * stride + c] += root.open_area * source.exitance[c];
    find_unshot();
}

void Shooting::deliver(const Received& received) {
    const std::size_t stride = radiosity_.columns.stride;
    parallel_for(
        received.light.size(),
        [&](std::size_t v) {
            if (!radiosity_.exposed[v] || received.unblocked[v] == 0) return;
            radiosity_.receive(VertexId(v), received.row(v, stride));
            radiosity_.variance[v] += received.variance[v];
        },
        1024);
}

void Shooting::weigh_patches() {
    const Mesh& mesh = radiosity_.mesh;
    if (weighed_elements_ == mesh.elements().size()) return;
    weighed_elements_ = mesh.elements().size();
    weight_begin_.assign(1, 0);
    weight_vertex_.clear();
    weight_.clear();
    patch_open_.assign(mesh.patches().size(), 0.0f);
    std::vector<Radiosity::Weight> mean;
    std::vector<std::pair<std::uint32_t, float>> sum;
    weigh_textures();
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
            patch_open_[weight_begin_.size() - 1] += area;
        }
        weight_begin_.push_back(static_cast<std::uint32_t>(weight_.size()));
    }
    const std::size_t stride = radiosity_.columns.stride;
    std::fill(patch_shot_.begin(), patch_shot_.end(), 0.0f);
    std::fill(rho_area_.begin(), rho_area_.end(), 0.0);
    open_area_ = 0;
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        const auto rho = mean_rho(p);
        for (std::size_t c = 0; c < stride; ++c) rho_area_[c] += double(patch_open_[p] * rho[c]);
        open_area_ += static_cast<double>(patch_open_[p]);
        mesh.for_leaves(mesh.patches()[p].root, [&](ElementId id) {
            const auto shot = radiosity_.shot[id];
            const float open = radiosity_.open_share(mesh[id]) * mesh[id].area;
            for (std::size_t c = 0; c < stride; ++c) patch_shot_[p * stride + c] += open * shot[c];
        });
    }
}

// Where reflectance varies over a patch, each element's part of a vertex's weight comes with the
// element's own: ρ H of the patch is Σ weight · ρ · H still.
void Shooting::weigh_textures() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    textured_.clear();
    std::vector<Radiosity::Weight> mean;
    for (std::size_t p = 0; p < mesh.patches().size(); ++p) {
        const Patch& patch = mesh.patches()[p];
        if (!radiosity_.textured(mesh[patch.face])) continue;
        textured_.resize(mesh.patches().size());
        TexturedPatch& entry = textured_[p];
        entry.mean_rho.assign(stride, 0.0f);
        float all = 0;
        mesh.for_leaves(patch.root, [&](ElementId id) {
            const auto rho = radiosity_.rho(id);
            const float open = radiosity_.open_share(mesh[id]) * mesh[id].area;
            all += open;
            for (std::size_t c = 0; c < stride; ++c) entry.mean_rho[c] += open * rho[c];
            radiosity_.mean_weights(id, mean);
            for (const Radiosity::Weight& w : mean)
                entry.terms.push_back({w.vertex, id, open * w.share});
        });
        for (float& rho : entry.mean_rho) rho = all > 0 ? rho / all : 0.0f;
    }
}

std::span<const float> Shooting::mean_rho(std::size_t patch) const {
    if (!textured_.empty() && !textured_[patch].mean_rho.empty()) return textured_[patch].mean_rho;
    return radiosity_.rho(radiosity_.mesh[radiosity_.mesh.patches()[patch].face]);
}

void Shooting::find_reflected(std::size_t patch, std::span<const float> received,
                              std::span<float> out) const {
    if (textured_.empty() || textured_[patch].mean_rho.empty()) {
        const auto rho = mean_rho(patch);
        for (std::size_t c = 0; c < out.size(); ++c) out[c] = rho[c] * received[c];
        return;
    }
    std::fill(out.begin(), out.end(), 0.0f);
    for (const TexturedPatch::Term& term : textured_[patch].terms) {
        const auto rho = radiosity_.rho(term.element);
        const auto H = radiosity_.irradiance[term.vertex];
        for (std::size_t c = 0; c < out.size(); ++c) out[c] += term.area * rho[c] * H[c];
    }
}

namespace {

struct FluxSums {
    std::vector<double> received, unshot;  ///< per column
    double square = 0;                     ///< of the patches' received luminance, over their area
    double magnitude = 0;                  ///< of what the patches have unshot

    FluxSums& operator+=(const FluxSums& other) {
        received.resize(std::max(received.size(), other.received.size()), 0.0);
        unshot.resize(received.size(), 0.0);
        for (std::size_t c = 0; c < other.received.size(); ++c) {
            received[c] += other.received[c];
            unshot[c] += other.unshot[c];
        }
        square += other.square;
        magnitude += other.magnitude;
        return *this;
    }
};

}  // namespace

void Shooting::find_unshot() {
    weigh_patches();
    const Mesh& mesh = radiosity_.mesh;
    const Columns& columns = radiosity_.columns;
    const std::size_t stride = columns.stride;
    const FluxSums sums = parallel_sum<FluxSums>(
        mesh.patches().size(),
        [&](std::size_t begin, std::size_t end) {
            FluxSums block{std::vector<double>(stride, 0.0), std::vector<double>(stride, 0.0)};
            std::vector<float> received(stride), reflected(stride);
            for (std::size_t p = begin; p < end; ++p) {
                std::fill(received.begin(), received.end(), 0.0f);
                for (std::uint32_t k = weight_begin_[p]; k < weight_begin_[p + 1]; ++k) {
                    const auto H = radiosity_.irradiance[VertexId(weight_vertex_[k])];
                    for (std::size_t c = 0; c < stride; ++c) received[c] += weight_[k] * H[c];
                }
                const std::span<float> unshot{&patch_unshot_[p * stride], stride};
                find_reflected(p, received, reflected);
                for (std::size_t c = 0; c < stride; ++c) {
                    unshot[c] = reflected[c] - patch_shot_[p * stride + c];
                    block.received[c] += static_cast<double>(received[c]);
                    block.unshot[c] += static_cast<double>(unshot[c]);
                }
                block.magnitude += static_cast<double>(columns.magnitude(unshot));
                const auto flux = static_cast<double>(columns.luminance(received));
                if (patch_open_[p] > 0) block.square += flux * flux / double(patch_open_[p]);
            }
            return block;
        },
        256);
    unshot_flux_ = sums.magnitude;
    unshot_column_ = sums.unshot;
    unshot_column_.resize(stride, 0.0);
    if (open_area_ <= 0) return;
    double received = 0;
    for (std::size_t c = 0; c < stride; ++c)
        received += double(columns.weight[c]) * sums.received[c];
    // As if the light lay evenly on a part of the area and the rest were dark.
    if (sums.square > 0) lit_share_ = received * received / (sums.square * open_area_);
    const double to_come = static_cast<double>(columns.luminance(ambient()));
    mean_irradiance_ = received / open_area_ + std::max(0.0, to_come);
}

std::vector<float> Shooting::ambient() const {
    std::vector<float> row(radiosity_.columns.stride, 0.0f);
    if (open_area_ <= 0) return row;
    for (std::size_t c = 0; c < radiosity_.columns.count; ++c)
        row[c] = static_cast<float>(unshot_column_[c] / (open_area_ - rho_area_[c]));
    return row;
}

float Shooting::tolerance() const {
    return static_cast<float>(std::max(options_.error * mean_irradiance_, 1e-30));
}

double Shooting::unshot() const {
    if (!radiosity_.emission_shot) return 1.0;
    return radiosity_.emitted_flux() > 0 ? unshot_flux_ / radiosity_.emitted_flux() : 0.0;
}

double Shooting::enough() const {
    // Unshot flux u adds u / (1-ρ) / A to the irradiance in the end, most in the band that is
    // reflected most.
    if (radiosity_.emitted_flux() <= 0) return 0.0;
    const double most_reflected = *std::max_element(rho_area_.begin(), rho_area_.end());
    return unshot_share * options_.error * mean_irradiance_ * (open_area_ - most_reflected) /
           radiosity_.emitted_flux();
}

double Shooting::next_shot() const {
    if (!radiosity_.emission_shot) return 1.0;
    const double flux = radiosity_.emitted_flux();
    return flux > 0 ? static_cast<double>(brightest().moved) / flux : 0.0;
}

Progress Shooting::progress() const {
    Progress out;
    out.phase = radiosity_.emission_shot ? "shooting" : "direct";
    out.fraction_left = unshot();
    out.shots = shots_;
    out.rays = rays_;
    out.vertices = radiosity_.receivers.size();
    out.sweeps = double(shots_) / double(radiosity_.mesh.patches().size());
    return out;
}

}  // namespace exitance
