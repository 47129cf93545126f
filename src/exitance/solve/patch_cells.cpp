// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/patch_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

// Cells of a patch, along a side. What varies faster than that is far smaller than the patch, and
// seen as a whole from everywhere but itself.
constexpr std::uint32_t most_steps = 8;
// A leaf is uneven if the light of its corners differs by this share; it is divided so often.
constexpr float uneven = 0.05f;
constexpr std::uint32_t levels_of_uneven = 2;

// What is taken out: at least so many times the mean, the brightest first; and only if that is so
// much of the mean square, which is what rays miss by.
constexpr float bright = 8;
constexpr std::size_t most_taken = 1024;
constexpr double worth_taking = 0.2;

constexpr std::uint64_t cell_numbers = 0xce11ULL;  // apart from those of elements and lamps

}  // namespace

PatchCells::PatchCells(Radiosity& radiosity, std::span<const ElementId> roots,
                       const PatchSlopes& slopes, std::size_t most_bytes)
    : radiosity_(radiosity), roots_(roots), slopes_(slopes), most_bytes_(most_bytes) {}

// Where in `exitance_` the cell at (x, y) of a patch is [steps along its sides].
std::size_t PatchCells::Cells::at(float x, float y) const {
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
void PatchCells::Cells::visit_those_of(const Element& leaf, const Element& root,
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
void PatchCells::divide(const RowField& received) {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    const double room = double(most_bytes_) / double(sizeof(float) * stride * (roots_.size() + 1));
    const double most = std::clamp(std::sqrt(room / 2), 1.0, double(most_steps));
    std::size_t count = 0;
    std::vector<float> along_s(stride), along_t(stride);
    cells_.clear();
    for (const ElementId root : roots_) {
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
        if (received.rows() > 0) {
            const PatchId patch = mesh[root].patch;
            slopes_.find(patch, received, along_s, along_t);
            const float rise = std::hypot(radiosity_.columns.luminance(along_s),
                                          radiosity_.columns.luminance(along_t));
            if (rise > uneven * radiosity_.columns.luminance(received[RowId(patch.index())]))
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
void PatchCells::fill(const RowField& received) {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    const bool balanced = received.rows() > 0;
    std::fill(exitance_.begin(), exitance_.end(), 0.0f);
    std::vector<float> area(exitance_.size() / stride, 0.0f);
    parallel_for(
        roots_.size(),
        [&](std::size_t i) {
            const Element& root = mesh[roots_[i]];
            std::vector<float> D(stride), slope_s(stride), slope_t(stride);
            std::vector<float> along_s(stride), along_t(stride);
            if (balanced) slopes_.find(PatchId(i), received, along_s, along_t);
            const float centre = root.count == 3 ? 1.0f / 3 : 0.5f;
            mesh.for_leaves(roots_[i], [&](ElementId id) {
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
                        light += received[RowId(i)][c] + (x + size * (s + middle)) * along_s[c] +
                                 (y + size * (t + middle)) * along_t[c];
                    return rho[c] * light;
                };
                for (std::size_t c = 0; open && c < stride; ++c)
                    shot[c] = std::max(0.0f, reflected(c, 0, 0));
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
                    exitance_[cell * stride + c] =
                        std::max(0.0f, exitance_[cell * stride + c] / area[cell]);
        },
        64);
}

// How direct light rises along the two sides of a leaf.
void PatchCells::find_slopes(const Element& leaf, std::span<float> s, std::span<float> t) const {
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

const float* PatchCells::exitance(std::uint32_t patch, float u, float v) const {
    const Cells& cells = cells_[patch];
    const auto steps = static_cast<float>(cells.steps);
    return &exitance_[cells.at(u * steps, v * steps) * radiosity_.columns.stride];
}

template <class Visit>
void PatchCells::Cells::visit_outlines(const Visit& visit) const {
    using Corner = std::array<float, 2>;
    const float step = 1.0f / static_cast<float>(steps);
    for (std::uint32_t j = 0; j < steps; ++j)
        for (std::uint32_t i = 0; i < steps; ++i) {
            const float s = static_cast<float>(i) * step, t = static_cast<float>(j) * step;
            const Corner a{s, t}, b{s + step, t}, c{s + step, t + step}, d{s, t + step};
            const std::size_t cell = first + (j * steps + i) * (triangle ? 2 : 1);
            if (!triangle) {
                visit(cell, std::array{a, b, c, d}, 4u);
                continue;
            }
            if (i + j < steps) visit(cell, std::array{a, b, d, d}, 3u);
            if (i + j + 1 < steps) visit(cell + 1, std::array{b, c, d, d}, 3u);
        }
}

std::vector<PatchCells::Bright> PatchCells::brighter_than(float level) const {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    std::vector<Bright> out;
    for (std::uint32_t p = 0; p < cells_.size(); ++p) {
        const auto c = mesh.corners(mesh[roots_[p]]);
        // As Embree has it: two triangles, so that outlines are straight.
        const auto place = [&](const std::array<float, 2>& at) {
            const double s = double(at[0]), t = double(at[1]);
            if (cells_[p].triangle) return c[0] + (c[1] - c[0]) * s + (c[2] - c[0]) * t;
            if (s + t <= 1) return c[0] + (c[1] - c[0]) * s + (c[3] - c[0]) * t;
            return c[2] + (c[3] - c[2]) * (1 - s) + (c[1] - c[2]) * (1 - t);
        };
        cells_[p].visit_outlines([&](std::size_t cell,
                                     const std::array<std::array<float, 2>, 4>& outline,
                                     std::uint32_t count) {
            Bright found;
            found.level = radiosity_.columns.luminance({&exitance_[cell * stride], stride});
            if (!(found.level > level)) return;
            found.patch = p, found.cell = static_cast<std::uint32_t>(cell);
            found.count = count;
            for (std::size_t k = 0; k < 4; ++k) found.corners[k] = place(outline[k]);
            found.area = static_cast<float>(area({found.corners.data(), count}));
            out.push_back(found);
        });
    }
    return out;
}

std::vector<Lamps::Placed> PatchCells::take_brightest() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    taken_.clear(), taken_from_.clear();
    double sum = 0, square = 0, all = 0;
    for (const Bright& cell : brighter_than(-1)) {
        const double light = double(cell.level) * double(cell.area);
        all += double(cell.area), sum += light, square += light * double(cell.level);
    }
    if (!(sum > 0)) return {};
    std::vector<Bright> taken = brighter_than(bright * static_cast<float>(sum / all));
    std::sort(taken.begin(), taken.end(), [](const Bright& a, const Bright& b) {
        return a.level != b.level ? a.level > b.level : a.cell < b.cell;
    });
    if (taken.size() > most_taken) taken.resize(most_taken);
    double of_taken = 0;
    for (const Bright& cell : taken) of_taken += double(cell.area * cell.level * cell.level);
    if (of_taken < worth_taking * square) return {};

    taken_.resize(taken.size() * stride);
    taken_from_.resize(roots_.size());
    std::vector<Lamps::Placed> lamps;
    for (std::size_t k = 0; k < taken.size(); ++k) {
        const Bright& cell = taken[k];
        const auto row = std::span(exitance_).subspan(cell.cell * stride, stride);
        const auto kept = std::span(taken_).subspan(k * stride, stride);
        std::copy(row.begin(), row.end(), kept.begin());
        std::fill(row.begin(), row.end(), 0.0f);
        const Element& root = mesh[roots_[cell.patch]];
        const float share = cell.area / root.area;
        taken_from_[cell.patch][0] += share * cell.level;
        taken_from_[cell.patch][1] += share * cell.level * cell.level;
        Lamp lamp;
        lamp.polygon.emplace(cell.corners, cell.count, radiosity_.caster.middle());
        lamp.polygon->covers =
            radiosity_.owners.covers(mesh.face_of(root).polygon, mesh.face_of(root).back);
        lamp.emitted = kept;
        lamp.level = cell.level;
        lamp.number = static_cast<std::uint32_t>(hash_bits(cell_numbers, cell.cell));
        lamps.push_back({lamp, centroid({cell.corners.data(), cell.count}), 0});
    }
    return lamps;
}

std::array<float, 2> PatchCells::taken_from(std::uint32_t patch) const {
    return taken_from_.empty() ? std::array<float, 2>{} : taken_from_[patch];
}

std::size_t PatchCells::bytes() const {
    return (exitance_.capacity() + taken_.capacity() + 2 * taken_from_.capacity()) * sizeof(float) +
           cells_.capacity() * sizeof(Cells);
}

}  // namespace exitance
