// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/reflected_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solve/cast_emission.h"
#include "exitance/solve/element_methods.h"
#include "exitance/transport/exchange_by_casting.h"
#include "exitance/transport/sparse.h"

namespace exitance {

namespace {

// A point sees many patches, whose errors are independent and average out: few rays each do, and
// fewer still where there are more than usual.
std::uint32_t balance_rays(double error, std::size_t patches) {
    constexpr double usual = 1e5;
    const double share = std::min(1.0, std::sqrt(usual / static_cast<double>(patches + 1)));
    return static_cast<std::uint32_t>(std::clamp(share * 128 * 0.02 / error, 16.0, 1024.0));
}

// What is left when the balance counts as struck: products are cheap, the rays have been cast.
constexpr double balance_residual = 1e-6;

// n stratified rays that meet exitances with standard deviation σ miss their mean by
// about 1.2 σ n^-3/4 (measured in rooms from 64 to 1024 rays).
constexpr float stratified = 1.2f;
constexpr std::uint32_t fewest_rays = 64, most_rays = 16384;

// Places at which that law is tried.
constexpr std::size_t trials = 256;

// A patch's own few rays do not know everything it sees: this share of the scene's mean square
// deviation is added.
constexpr double unseen_share = 0.05;

// Patches as rows of the linear system, with the area that neither stands under something else nor
// belongs to another polygon.
ElementRows patch_rows(const Radiosity& radiosity) {
    ElementRows rows;
    for (const Patch& patch : radiosity.mesh.patches()) {
        float open = 0;
        radiosity.mesh.for_leaves(patch.root, [&](ElementId id) {
            open += radiosity.open_share(radiosity.mesh[id]) * radiosity.mesh[id].area;
        });
        rows.elements.push_back(patch.root);
        rows.area.push_back(open);
    }
    return rows;
}

}  // namespace

ReflectedLight::ReflectedLight(Radiosity& radiosity, const ReflectedLightOptions& options)
    : radiosity_(radiosity),
      options_(options),
      scene_{radiosity.mesh, radiosity.caster, radiosity.owners, radiosity.two_sided()},
      rows_(patch_rows(radiosity)),
      slopes_(radiosity.mesh, rows_.area),
      cells_(radiosity, rows_.elements, slopes_, options.most_cell_bytes),
      caster_(scene_, rows_, std::min(balance_rays(options.error, rows_.size()), options.most_rays),
              hash_bits(options.column.seed, 1)) {
    cells_.divide(irradiance_);
    balance();
}

bool ReflectedLight::lacks_rays() const {
    return options_.most_rays < balance_rays(options_.error, rows_.size());
}

// R = ρ (D + F R) on the patches, as exchange areas in a sparse matrix.
void ReflectedLight::balance() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t n = rows_.size(), stride = radiosity_.columns.stride,
                      columns = radiosity_.columns.count;
    ElementSystem system{radiosity_.columns,   rows_.area,           RowField(n, columns),
                         RowField(n, columns), RowField(n, columns), radiosity_.emitted_flux()};
    RowField square(n, 1);  // mean square of the luminance of ρ D, for the spread
    parallel_for(
        n,
        [&](std::size_t i) {
            std::vector<float> H(stride);
            const auto D = system.direct[RowId(i)], rho = system.rho[RowId(i)];
            mesh.for_leaves(rows_.elements[i], [&](ElementId id) {
                const float open = radiosity_.open_share(mesh[id]) * mesh[id].area;
                if (!(open > 0)) return;
                const float share = open / rows_.area[i];
                radiosity_.mean_irradiance(id, H);
                const auto reflectance = radiosity_.rho(id);
                for (std::size_t c = 0; c < stride; ++c) {
                    D[c] += share * H[c], rho[c] += share * reflectance[c];
                    H[c] *= reflectance[c];
                }
                const float level = radiosity_.columns.luminance(H);
                square[RowId(i)][0] += share * level * level;
            });
        },
        64);
    // Patches exchange light as if each sent it evenly. What those that do not send differently is
    // seen by the rays: it is added to what patches receive, and goes on from there.
    RowField not_even(n, columns);
    std::vector<std::uint32_t> looks(n, 0);
    cells_.fill(irradiance_);
    const auto look = [&](std::size_t i, const ElementCaster::Ends& ends) {
        const auto more = not_even[RowId(i)];
        for (std::uint32_t k = 0; k < ends.count; ++k) {
            if (cells_.is_even(ends.row[k])) continue;
            const float* here = cells_.exitance(ends.row[k], ends.u[k], ends.v[k]);
            const auto D = system.direct[RowId(ends.row[k])], rho = system.rho[RowId(ends.row[k])];
            for (std::size_t c = 0; c < stride; ++c)
                more[c] += ends.rays[k] * (here[c] - rho[c] * D[c]);
        }
        ++looks[i];
    };
    ExchangeAreas areas = cast_exchange_areas(
        caster_, rows_,
        [&](std::uint64_t) { return !(options_.interrupted && options_.interrupted()); }, look,
        mesh);
    system.area = rows_.area;
    for (std::size_t i = 0; i < n; ++i) {
        if (looks[i] == 0) continue;
        const auto more = not_even[RowId(i)], D = system.direct[RowId(i)];
        for (std::size_t c = 0; c < stride; ++c) {
            more[c] /= static_cast<float>(looks[i] * RayPacket::width);
            D[c] += more[c];
        }
    }
    rays_ += std::uint64_t{n} * caster_.rays();
    SparseTransport transport(std::move(areas), rows_.area, 0.0);
    ElementSolverOptions solving;
    solving.error = balance_residual;
    const auto solver = element_method("jacobi").make(system, transport, solving);
    run(*solver, Stop{}, Stopwatch(), {});
    const RowField& R = solver->reflected();
    irradiance_ = RowField(n, columns);
    transport.gather(R, irradiance_);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < stride; ++c) irradiance_[RowId(i)][c] += not_even[RowId(i)][c];
    cells_.divide(irradiance_);
    cells_.fill(irradiance_);
    bright_.emplace(cells_.take_brightest());

    // σ² = F R² − (F R)², of what is left to the rays.
    RowField taken(n, 1);
    double mean_square = 0, area = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto rho = system.rho[RowId(i)], D = system.direct[RowId(i)];
        std::vector<float> first(stride);
        for (std::size_t c = 0; c < stride; ++c) first[c] = rho[c] * (D[c] - not_even[RowId(i)][c]);
        const float all = radiosity_.columns.luminance(R[RowId(i)]);
        const float of_direct = radiosity_.columns.luminance(first);
        const auto [level, level_square] = cells_.taken_from(static_cast<std::uint32_t>(i));
        taken[RowId(i)][0] = level;
        square[RowId(i)][0] += all * all - of_direct * of_direct - level_square;
    }
    RowField seen(n, 1), seen_taken(n, 1);
    transport.gather(square, seen);
    if (bright_->size() > 0) transport.gather(taken, seen_taken);
    spread_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const float mean =
            radiosity_.columns.luminance(irradiance_[RowId(i)]) - seen_taken[RowId(i)][0];
        spread_[i] = std::max(0.0f, seen[RowId(i)][0] - mean * mean);
        mean_square += double(spread_[i] * rows_.area[i]), area += double(rows_.area[i]);
    }
    const auto more = static_cast<float>(area > 0 ? unseen_share * mean_square / area : 0.0);
    for (float& spread : spread_) spread = std::sqrt(spread + more);
}

// What varies from patch to patch without order is not stratified away: it falls as n^-1/2.
std::uint32_t ReflectedLight::rays_for(PatchId patch, float deviation) const {
    const double n = std::pow(double(stratified * spread_[patch.index()] / deviation), 4.0 / 3.0) *
                     std::pow(double(unevenness_), unevenness_ > 1 ? 2.0 : 4.0 / 3.0);
    const double nearest = std::exp2(std::round(std::log2(std::max(n, 1.0))));
    return static_cast<std::uint32_t>(std::clamp(nearest, double(fewest_rays), double(most_rays)));
}

float ReflectedLight::deviation(PatchId patch, std::uint32_t rays) const {
    const auto n = static_cast<float>(rays);
    return stratified * spread_[patch.index()] * unevenness_ * std::pow(n, -0.75f);
}

void ReflectedLight::calibrate(float deviation) {
    unevenness_ = 1;
    tolerance_ = deviation;
    Receivers points;
    std::vector<std::uint32_t> rays;
    std::vector<PatchId> patches;
    const std::size_t step = std::max<std::size_t>(1, rows_.size() / trials);
    for (std::size_t p = 0; p < rows_.size(); p += step) {
        const Element& root = radiosity_.mesh[rows_.elements[p]];
        if (!(rows_.area[p] > 0)) continue;
        const auto corners = radiosity_.mesh.corners(root);
        points.add(centroid({corners.data(), root.count}) - radiosity_.caster.middle(),
                   scene_.face(rows_.elements[p]).normal,
                   static_cast<std::uint32_t>(hash_bits(0x7a1, p)));
        patches.push_back(PatchId(p));
        rays.push_back(rays_for(patches.back(), deviation));
    }
    Received received;
    received.reset(points.size(), radiosity_.columns.stride);
    std::vector<Surroundings> around(points.size());
    rays_ += gather(points, rays, received, around);
    double found = 0, expected = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        found += double(received.variance[i]);
        expected += std::pow(double(this->deviation(patches[i], rays[i])), 2);
    }
    if (expected > 0)
        unevenness_ = static_cast<float>(std::clamp(std::sqrt(found / expected), 0.5, 4.0));
}

std::uint64_t ReflectedLight::gather(const Receivers& receivers,
                                     std::span<const std::uint32_t> rays, Received& received,
                                     std::span<Surroundings> around) const {
    const std::size_t stride = radiosity_.columns.stride;
    const Vec3 middle = radiosity_.caster.middle();
    parallel_for(
        receivers.size(),
        [&](std::size_t i) {
            const Vec3 point = Vec3(receivers.point(i)) + middle, normal(receivers.normal(i));
            const std::uint64_t key = hash_bits(options_.column.seed, 0x7e7, receivers.key[i]);
            float* sum = &received.rows[i * stride];
            float first_half = 0;
            const auto each = 1.0f / static_cast<float>(rays[i]);
            std::uint32_t backs = 0;
            float inverse = 0;
            ElementCaster::Ends ends;
            for (std::uint32_t packet = 0; packet * RayPacket::width < rays[i]; ++packet) {
                if (2 * packet * RayPacket::width == rays[i])
                    first_half = radiosity_.columns.luminance({sum, stride});
                caster_.cast_packet(point, normal, key, packet, ends);
                backs += ends.black;
                for (std::uint32_t k = 0; k < ends.count; ++k) {
                    const float* R = cells_.exitance(ends.row[k], ends.u[k], ends.v[k]);
                    const float share = each * ends.rays[k];
                    inverse += each / ends.distance[k];
                    for (std::size_t c = 0; c < stride; ++c) sum[c] += share * R[c];
                }
            }
            around[i] = {static_cast<float>(backs) * each, inverse};
            const float level = radiosity_.columns.luminance({sum, stride});
            received.light[i] += level, received.unblocked[i] += level;
            const float second_half = level - first_half;
            received.variance[i] += (first_half - second_half) * (first_half - second_half);
        },
        16);
    std::uint64_t cast = 0;
    for (const std::uint32_t n : rays) cast += n;
    if (bright_->size() == 0) return cast;
    std::vector<std::uint32_t> everyone(receivers.size());
    std::iota(everyone.begin(), everyone.end(), 0u);
    return cast + cast_lamps(radiosity_, *bright_, receivers, everyone, tolerance_, options_.column,
                             received);
}

std::size_t ReflectedLight::bytes() const {
    return cells_.bytes() + irradiance_.bytes() + spread_.capacity() * sizeof(float) +
           caster_.bytes();
}

}  // namespace exitance
