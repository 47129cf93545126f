// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/reflected_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
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

// Cells of a patch, along a side. What varies faster than that is far smaller than the patch, and
// seen as a whole from everywhere but itself.
constexpr std::uint32_t most_steps = 8;
// A leaf is uneven if the light of its corners differs by this share; it is divided so often.
constexpr float uneven = 0.05f;
constexpr std::uint32_t levels_of_uneven = 2;

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
      caster_(scene_, rows_, std::min(balance_rays(options.error, rows_.size()), options.most_rays),
              hash_bits(options.seed, 1)) {
    divide_into_cells();
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
    fill_cells();
    const auto look = [&](std::size_t i, const ElementCaster::Ends& ends) {
        const auto more = not_even[RowId(i)];
        for (std::uint32_t k = 0; k < ends.count; ++k) {
            if (cells_[ends.row[k]].steps == 1) continue;
            const float* here = exitance_at(ends.row[k], ends.u[k], ends.v[k]);
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
    divide_into_cells();
    fill_cells();

    // σ² = F R² − (F R)².
    double mean_square = 0, area = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto rho = system.rho[RowId(i)], D = system.direct[RowId(i)];
        std::vector<float> first(stride);
        for (std::size_t c = 0; c < stride; ++c) first[c] = rho[c] * (D[c] - not_even[RowId(i)][c]);
        const float all = radiosity_.columns.luminance(R[RowId(i)]);
        const float of_direct = radiosity_.columns.luminance(first);
        square[RowId(i)][0] += all * all - of_direct * of_direct;
    }
    RowField seen(n, 1);
    transport.gather(square, seen);
    spread_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const float mean = radiosity_.columns.luminance(irradiance_[RowId(i)]);
        spread_[i] = std::max(0.0f, seen[RowId(i)][0] - mean * mean);
        mean_square += double(spread_[i] * rows_.area[i]), area += double(rows_.area[i]);
    }
    const auto more = static_cast<float>(area > 0 ? unseen_share * mean_square / area : 0.0);
    for (float& spread : spread_) spread = std::sqrt(spread + more);
}

// Where in `exitance_` the cell at (x, y) of a patch is [steps along its sides].
std::size_t ReflectedLight::Cells::at(float x, float y) const {
    if (steps == 1) return first;
    const float most = static_cast<float>(steps) - 0.5f;
    x = std::clamp(x, 0.0f, most), y = std::clamp(y, 0.0f, most);
    const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
    if (!triangle) return first + j * steps + i;
    const bool upper = x - static_cast<float>(i) + y - static_cast<float>(j) > 1.0f;
    return first + 2 * (j * steps + i) + (upper ? 1 : 0);
}

// Calls `visit(cell, s, t)` for those whose middles lie in `leaf`, or for the one its own middle
// lies in; (s, t): where that is, in sides of the leaf.
template <class Visit>
void ReflectedLight::Cells::visit_those_of(const Element& leaf, const Element& root,
                                           const Visit& visit) const {
    const float step = static_cast<float>(steps) / static_cast<float>(root.size);
    const float x = step * static_cast<float>(leaf.u - root.u);
    const float y = step * static_cast<float>(leaf.v - root.v);
    const float h = step * static_cast<float>(leaf.size);  // < 0: a triangle that points back
    if (std::abs(h) < 1.0f || steps == 1) {
        const float middle = triangle ? 1.0f / 3 : 0.5f;
        return visit(at(x + middle * h, y + middle * h), middle, middle);
    }
    const float u_begin = std::round(std::min(x, x + h)), v_begin = std::round(std::min(y, y + h));
    for (float v = v_begin; v < v_begin + std::abs(h) - 0.5f; ++v)
        for (float u = u_begin; u < u_begin + std::abs(h) - 0.5f; ++u) {
            if (!triangle) {
                visit(at(u + 0.5f, v + 0.5f), (u + 0.5f - x) / h, (v + 0.5f - y) / h);
                continue;
            }
            for (const float third : {1.0f / 3, 2.0f / 3}) {
                const float s = (u + third - x) / h, t = (v + third - y) / h;
                if (s + t < 1.0f) visit(at(u + third, v + third), s, t);
            }
        }
}

// As fine as the mesh; where direct light differs within a large leaf, as fine as that needs.
void ReflectedLight::divide_into_cells() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    const double room =
        double(options_.most_cell_bytes) / double(sizeof(float) * stride * (rows_.size() + 1));
    const double most = std::clamp(std::sqrt(room / 2), 1.0, double(most_steps));
    std::size_t count = 0;
    std::vector<float> along_s(stride), along_t(stride);
    cells_.clear();
    for (const ElementId root : rows_.elements) {
        std::uint32_t levels = 0;
        mesh.for_leaves(root, [&](ElementId id) {
            const Element& leaf = mesh[id];
            levels = std::max<std::uint32_t>(levels, leaf.level);
            float low = INFINITY, high = 0;
            for (const VertexId v : leaf.corners()) {
                const float light = radiosity_.columns.luminance(radiosity_.irradiance[v]);
                low = std::min(low, light), high = std::max(high, light);
            }
            if (high - low > uneven * high)
                levels = std::max<std::uint32_t>(levels, leaf.level + levels_of_uneven);
        });
        if (irradiance_.rows() > 0) {
            const PatchId patch = mesh[root].patch;
            slopes_.find(patch, irradiance_, along_s, along_t);
            const float rise = std::hypot(radiosity_.columns.luminance(along_s),
                                          radiosity_.columns.luminance(along_t));
            if (rise > uneven * radiosity_.columns.luminance(irradiance_[RowId(patch.index())]))
                levels = std::max(levels, levels_of_uneven);
        }
        Cells cells;
        cells.first = static_cast<std::uint32_t>(count);
        cells.steps = std::min(std::bit_floor(static_cast<std::uint32_t>(most)), 1u << levels);
        cells.triangle = mesh[root].count == 3;
        count += cells.count();
        cells_.push_back(cells);
    }
    exitance_.resize(count * stride);
}

// R = ρ (D + F R), D and ρ of the leaves, F R of their patch and its neighbours if it is known.
void ReflectedLight::fill_cells() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    const bool balanced = irradiance_.rows() > 0;
    std::fill(exitance_.begin(), exitance_.end(), 0.0f);
    std::vector<float> area(exitance_.size() / stride, 0.0f);
    parallel_for(
        rows_.size(),
        [&](std::size_t i) {
            const Element& root = mesh[rows_.elements[i]];
            std::vector<float> D(stride), slope_s(stride), slope_t(stride);
            std::vector<float> along_s(stride), along_t(stride);
            if (balanced) slopes_.find(PatchId(i), irradiance_, along_s, along_t);
            const float centre = root.count == 3 ? 1.0f / 3 : 0.5f;
            mesh.for_leaves(rows_.elements[i], [&](ElementId id) {
                const Element& leaf = mesh[id];
                const auto shot = radiosity_.shot[id];
                std::fill(shot.begin(), shot.end(), 0.0f);
                const bool open = radiosity_.open_share(leaf) > 0;
                if (open) {
                    radiosity_.mean_irradiance(id, D);
                    find_slopes(leaf, slope_s, slope_t);
                }
                const auto rho = radiosity_.rho(id);
                const float x = float(leaf.u - root.u) / float(root.size) - centre;
                const float y = float(leaf.v - root.v) / float(root.size) - centre;
                const float size = float(leaf.size) / float(root.size);
                const float middle = leaf.count == 3 ? 1.0f / 3 : 0.5f;
                const auto reflected = [&](std::size_t c, float s, float t) {
                    float light = D[c] + s * slope_s[c] + t * slope_t[c];
                    if (balanced)
                        light += irradiance_[RowId(i)][c] + (x + size * (s + middle)) * along_s[c] +
                                 (y + size * (t + middle)) * along_t[c];
                    return rho[c] * light;
                };
                for (std::size_t c = 0; open && c < stride; ++c) shot[c] = reflected(c, 0, 0);
                cells_[i].visit_those_of(leaf, root, [&](std::size_t cell, float s, float t) {
                    area[cell] += leaf.area;
                    for (std::size_t c = 0; open && c < stride; ++c)
                        exitance_[cell * stride + c] +=
                            leaf.area * reflected(c, s - middle, t - middle);
                });
            });
            const Cells& own = cells_[i];
            for (std::size_t cell = own.first; cell < own.first + own.count(); ++cell)
                for (std::size_t c = 0; area[cell] > 0 && c < stride; ++c)
                    exitance_[cell * stride + c] /= area[cell];
        },
        64);
}

// How direct light rises along the two sides of a leaf.
void ReflectedLight::find_slopes(const Element& leaf, std::span<float> s,
                                 std::span<float> t) const {
    std::fill(s.begin(), s.end(), 0.0f);
    std::fill(t.begin(), t.end(), 0.0f);
    for (const VertexId v : leaf.corners())
        if (!radiosity_.exposed[v.index()]) return;
    const auto H = [&](std::uint32_t corner) {
        return radiosity_.irradiance[leaf.vertices[corner]];
    };
    for (std::size_t c = 0; c < s.size(); ++c) {
        if (leaf.count == 3)
            s[c] = H(1)[c] - H(0)[c], t[c] = H(2)[c] - H(0)[c];
        else
            s[c] = 0.5f * (H(1)[c] + H(2)[c] - H(0)[c] - H(3)[c]),
            t[c] = 0.5f * (H(3)[c] + H(2)[c] - H(0)[c] - H(1)[c]);
    }
}

const float* ReflectedLight::exitance_at(std::uint32_t patch, float u, float v) const {
    const Cells& cells = cells_[patch];
    const auto steps = static_cast<float>(cells.steps);
    return &exitance_[cells.at(u * steps, v * steps) * radiosity_.columns.stride];
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
            const std::uint64_t key = hash_bits(options_.seed, 0x7e7, receivers.key[i]);
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
                    const float* R = exitance_at(ends.row[k], ends.u[k], ends.v[k]);
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
    return cast;
}

std::size_t ReflectedLight::bytes() const {
    return exitance_.capacity() * sizeof(float) + cells_.capacity() * sizeof(Cells) +
           irradiance_.bytes() + spread_.capacity() * sizeof(float) + caster_.bytes();
}

}  // namespace exitance
