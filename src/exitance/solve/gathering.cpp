// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/gathering.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "exitance/solve/cast_emission.h"
#include "exitance/solve/merge.h"
#include "exitance/solve/refine.h"

namespace exitance {

namespace {

// Of the tolerance: what merging may change.
constexpr float merge_share = 0.25f;

// What is looked at is taken to be no darker than this share of the scene's mean; held-out points
// ask for more where it is.
constexpr double least_brightness = 0.1;

// Error of a sketch: nothing is asked of it but light everywhere.
constexpr double roughest = 1;

// Finding the obstacles of a scene takes some microseconds per polygon; where there are more, most
// are parts of round bodies that stand in each other's way, and rays are needed all the same.
constexpr std::size_t most_polygons_as_obstacles = 20000;

std::optional<Obstacles> obstacles_of(const Radiosity& radiosity) {
    const Scene& scene = radiosity.scene;
    if (scene.polygons.size() > most_polygons_as_obstacles || radiosity.caster.has_glass())
        return {};
    std::vector<std::array<Vec3, 4>> corners;
    for (const Polygon& polygon : scene.polygons) {
        corners.push_back(scene.corners(polygon));
        for (Vec3& corner : corners.back()) corner = corner - radiosity.caster.middle();
    }
    std::vector<std::span<const Vec3>> outlines;
    for (std::size_t p = 0; p < corners.size(); ++p)
        outlines.emplace_back(corners[p].data(), scene.polygons[p].size());
    return Obstacles(outlines);
}

}  // namespace

Gathering::Gathering(Radiosity& radiosity, const GatheringOptions& options)
    : radiosity_(radiosity),
      options_(options),
      lamps_(radiosity),
      obstacles_(obstacles_of(radiosity)),
      direct_(0, radiosity.columns.count),
      mean_irradiance_(radiosity.area() > 0 ? radiosity.emitted_flux() / radiosity.area() : 0.0) {
    if (options.sketch) phase_ = Phase::sketch;
    if (options.importance) of_direct_light_ = options.importance->of_direct_light();
    if (obstacles_) options_.column.obstacles = &*obstacles_;
}

float Gathering::tolerance() const {
    return static_cast<float>(std::max(options_.error * mean_irradiance_, 1e-30));
}

// As many elements as there are patches, each wrong by the tolerance, are wrong by it together.
float Gathering::patch_area() const {
    return static_cast<float>(radiosity_.area() /
                              static_cast<double>(radiosity_.mesh.patches().size()));
}

bool Gathering::step() {
    switch (phase_) {
        case Phase::sketch:
            sketch();
            phase_ = Phase::direct;
            return true;
        case Phase::direct:
            light_directly();
            phase_ = Phase::balance;
            return true;
        case Phase::balance:
            strike_balance();
            phase_ = Phase::gather;
            return true;
        case Phase::gather:
            ++level_;
            if (!indirect_->step()) {
                finish();
                phase_ = options_.merge ? Phase::merge : Phase::done;
            }
            if (options_.memory &&
                radiosity_.mesh.vertices().size() >= options_.memory->most_vertices())
                full_ = true;
            complete_direct();
            combine();
            return true;
        case Phase::merge:
            merge();
            phase_ = Phase::done;
            return true;
        case Phase::done:
            break;
    }
    return false;
}

void Gathering::finish() {
    if (!indirect_) sketch();
    if (phase_ != Phase::gather) return;
    indirect_->finish();
    rays_ += indirect_->rays();
    complete_direct();
    combine();
}

double Gathering::unshot() const {
    switch (phase_) {
        case Phase::sketch:
        case Phase::direct:
            return 1.0;
        case Phase::balance:
            return 0.8;
        case Phase::gather:
            return 0.6 / (1 + level_);
        case Phase::merge:
            return 0.02;
        case Phase::done:
            break;
    }
    return 0.0;
}

void Gathering::demand(double error, double min_area) {
    options_.error = error;
    options_.min_area = min_area;
    phase_ = Phase::direct;
    level_ = 0;
}

std::uint64_t Gathering::cast_direct(const Receivers& receivers, Received& received) const {
    std::vector<std::uint32_t> which(receivers.size());
    std::iota(which.begin(), which.end(), 0u);
    return cast_emission(radiosity_, lamps_, receivers, which, tolerance(), options_.column,
                         received);
}

// To the end, whatever interrupts: there is nothing better to keep. What it finds of direct light
// is forgotten, it is too rough to divide elements by.
void Gathering::sketch() {
    const double error = std::exchange(options_.error, std::max(roughest, options_.error));
    complete_direct();
    radiosity_.emission_shot = true;
    balance_patches(options_.error, {});
    options_.error = error;
}

void Gathering::light_directly() {
    if (thorough_) rays_ = 0;  // those of a sketch are not what the solution is made of
    direct_.resize_rows(0);
    direct_variance_.clear();
    complete_direct();
    radiosity_.irradiance = direct_;
    radiosity_.variance = direct_variance_;
    radiosity_.emission_shot = true;
    weigh();
    if (options_.adaptive) {
        RefineOptions refining;
        refining.tolerance = tolerance();
        refining.area = patch_area();
        refining.min_area = min_area();
        refining.thorough = std::exchange(thorough_, false);
        refining.shared_noise = true;
        refining.gross = 16;
        refining.importance = of_direct_light_;
        refining.interrupted = options_.interrupted;
        if (options_.memory) refining.most_vertices = options_.memory->most_vertices_of_direct();
        rays_ += refine(radiosity_, refining, [&](const Receivers& points, Received& lit) {
            return cast_direct(points, lit);
        });
        full_ = radiosity_.mesh.vertices().size() >= refining.most_vertices;
        weigh();
    }
    direct_ = radiosity_.irradiance;
    direct_variance_ = radiosity_.variance;
    // Until the next balance the last one goes on to stand for what is reflected.
    if (!indirect_) return;
    indirect_->admit_new_vertices();
    combine();
}

void Gathering::complete_direct() {
    const std::size_t known = direct_.rows(), count = radiosity_.receivers.size();
    if (known == count) return;
    Receivers rest;
    const Receivers& everyone = radiosity_.receivers;
    for (std::size_t v = known; v < count; ++v)
        rest.add(Vec3(everyone.point(v)), Vec3(everyone.normal(v)), everyone.key[v]);
    Received received;
    received.reset(rest.size(), radiosity_.columns.stride);
    rays_ += cast_direct(rest, received);
    direct_.resize_rows(count);
    direct_variance_.resize(count);
    for (std::size_t v = known; v < count; ++v) {
        radiosity_.seen[v] = received.seen[v - known];
        if (!radiosity_.exposed[v]) continue;
        const auto row = received.row(v - known, radiosity_.columns.stride);
        std::copy(row.begin(), row.end(), direct_[VertexId(v)].begin());
        direct_variance_[v] = received.variance[v - known];
    }
}

// Mean irradiance where somebody looks, and what share of the area light is spread over. Before
// the balance it may be dark there.
void Gathering::weigh() {
    const Mesh& mesh = radiosity_.mesh;
    std::vector<float> row(radiosity_.columns.stride);
    double received = 0, square = 0, area = 0, received_anywhere = 0, area_anywhere = 0;
    for (const Patch& patch : mesh.patches()) {
        const double shown =
            options_.importance ? double(options_.importance->shown[mesh[patch.root].patch.index()])
                                : 1.0;
        double flux = 0, open_area = 0;
        mesh.for_leaves(patch.root, [&](ElementId id) {
            const double open = double(radiosity_.open_share(mesh[id]) * mesh[id].area);
            radiosity_.mean_irradiance(id, row);
            flux += open * double(radiosity_.columns.luminance(row));
            open_area += open;
        });
        received_anywhere += flux, area_anywhere += open_area;
        received += shown * flux, area += shown * open_area;
        if (open_area > 0) square += shown * flux * flux / open_area;
    }
    if (square > 0) lit_share_ = received * received / (square * area);
    if (area > 0)
        mean_irradiance_ =
            std::max(received / area, least_brightness * received_anywhere / area_anywhere);
}

void Gathering::strike_balance() {
    balance_patches(options_.error, options_.interrupted);
    // What was cut short lacks light.
    if (options_.interrupted && options_.interrupted()) balance_patches(roughest, {});
    weigh();
    indirect_->set_tolerance(tolerance(), min_area());
}

void Gathering::balance_patches(double error, const std::function<bool()>& interrupted) {
    radiosity_.irradiance = direct_;
    indirect_.reset();
    reflected_.reset();
    ReflectedLightOptions balancing{error, options_.column, interrupted};
    if (options_.memory) {
        balancing.most_rays =
            options_.memory->patch_rays(balancing.most_rays, radiosity_.mesh.vertices().size());
        balancing.most_cell_bytes = options_.memory->most_cell_bytes();
    }
    reflected_.emplace(radiosity_, balancing);
    rays_ += reflected_->rays();
    IndirectOptions gathering;
    gathering.area = patch_area();
    gathering.adaptive = options_.adaptive;
    if (options_.importance) gathering.shown = options_.importance->shown;
    gathering.interrupted = options_.interrupted;
    if (options_.memory) gathering.most_vertices = options_.memory->most_vertices();
    indirect_.emplace(radiosity_, *reflected_, gathering);
    combine();
}

void Gathering::combine() {
    const std::size_t stride = radiosity_.columns.stride;
    for (std::size_t i = 0; i < direct_.rows(); ++i) {
        const VertexId v(i);
        const auto H = radiosity_.irradiance[v], D = direct_[v], I = indirect_->irradiance[v];
        for (std::size_t c = 0; c < stride; ++c) H[c] = D[c] + I[c];
        radiosity_.variance[i] = direct_variance_[i] + indirect_->variance[i];
    }
}

void Gathering::merge() {
    const Mesh& mesh = radiosity_.mesh;
    // What the children have sent, their parents have.
    const auto add_up = [&](const auto& self, ElementId id) -> void {
        const Element& element = mesh[id];
        if (element.leaf()) return;
        const auto shot = radiosity_.shot[id];
        std::fill(shot.begin(), shot.end(), 0.0f);
        for (std::size_t k = 0; k < 4; ++k) {
            const ElementId child(element.first_child.index() + k);
            self(self, child);
            const float share = mesh[child].area / element.area;
            const auto part = radiosity_.shot[child];
            for (std::size_t c = 0; c < shot.size(); ++c) shot[c] += share * part[c];
        }
    };
    for (const Patch& patch : mesh.patches()) add_up(add_up, patch.root);
    merge_smooth(radiosity_, merge_share * tolerance());
}

Progress Gathering::progress() const {
    Progress out;
    out.phase = phase_ <= Phase::direct    ? "direct"
                : phase_ == Phase::balance ? "balance"
                                           : "gathering";
    out.fraction_left = unshot();
    out.rays = rays_ + (indirect_ && phase_ == Phase::gather ? indirect_->rays() : 0);
    out.vertices = radiosity_.receivers.size();
    return out;
}

std::optional<std::uint32_t> Gathering::scarce_patch_rays() const {
    if (!reflected_ || !reflected_->lacks_rays()) return {};
    return reflected_->patch_rays();
}

std::size_t Gathering::bytes() const {
    return radiosity_.bytes() + direct_.bytes() + (reflected_ ? reflected_->bytes() : 0) +
           (indirect_ ? indirect_->irradiance.bytes() : 0) + (obstacles_ ? obstacles_->bytes() : 0);
}

}  // namespace exitance
