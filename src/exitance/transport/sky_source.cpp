// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/sky_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

namespace {

constexpr std::uint32_t finest_of_models = 6;
constexpr std::uint32_t samples = 4;  // along each side of a finest cell, for its integral

}  // namespace

SkySource::Cell SkySource::Cell::child(std::uint32_t k) const {
    const std::uint32_t in_level = 1u << (2 * level);
    const std::uint32_t own = index - (lower ? in_level : 0);
    Cell out;
    out.level = level + 1;
    out.lower = lower;
    out.index = 4 * own + k + (lower ? 4 * in_level : 0);
    out.u = u + (k & 1u ? 0.5 * size() : 0);
    out.v = v + (k & 2u ? 0.5 * size() : 0);
    return out;
}

Vec3 SkySource::Cell::direction(double s, double t) const {
    return direction_of({lower, u + s * size(), v + t * size()});
}

SkySource::SkySource(const DistantLight& light)
    : light_(light),
      bands_(light.colour.size()),
      finest_(light.map ? std::max(coarsest, light.map->level) : finest_of_models) {
    std::size_t count = 0;
    for (std::uint32_t level = 0; level <= finest_; ++level) {
        first_.push_back(count);
        count += std::size_t{2} << (2 * level);
    }
    nodes_.resize(count);
    vectors_.resize(count * bands_);
    const Spectrum weights = luminance_weights(bands_);
    const auto fill = [&](const auto& self, const Cell& cell) -> void {
        const std::size_t here = at(cell);
        Vec3* J = &vectors_[here * bands_];
        if (cell.level == finest_) {
            // All cells of a level have the same solid angle.
            const double part =
                2 * std::numbers::pi / double(1u << (2 * finest_)) / (samples * samples);
            for (std::uint32_t i = 0; i < samples * samples; ++i) {
                const Vec3 d =
                    cell.direction((i % samples + 0.5) / samples, (i / samples + 0.5) / samples);
                const Spectrum L = light_.radiance(d);
                for (std::size_t b = 0; b < bands_; ++b) J[b] += d * (L[b] * part);
            }
        } else {
            for (std::uint32_t k = 0; k < 4; ++k) {
                const Cell child = cell.child(k);
                self(self, child);
                for (std::size_t b = 0; b < bands_; ++b) J[b] += vectors_[at(child) * bands_ + b];
            }
        }
        Node& node = nodes_[here];
        for (std::size_t b = 0; b < bands_; ++b) node.luminance += J[b] * weights[b];
        node.axis = cell.direction(0.5, 0.5);
        double least =
            1;  // cosine of the farthest corner; sides bend outwards by far less than 2 %
        for (std::uint32_t k = 0; k < 4; ++k)
            least = std::min(least, dot(node.axis, cell.direction(k & 1u, k >> 1)));
        node.sine = cell.level < 2
                        ? 1.0
                        : std::min(1.0, 1.02 * std::sqrt(std::max(0.0, 1 - least * least)));
    };
    for (const bool lower : {false, true}) fill(fill, Cell{0, lower ? 1u : 0u, 0, 0, lower});
}

std::size_t SkySource::at(const Cell& cell) const {
    return first_[cell.level] + cell.index;
}

std::vector<SkySource::Cell> SkySource::roots() const {
    std::vector<Cell> out;
    for (const bool lower : {false, true}) {
        const Cell root{0, lower ? 1u : 0u, 0, 0, lower};
        const Vec3 J = nodes_[at(root)].luminance;
        if (dot(J, J) > 0) out.push_back(root);
    }
    return out;
}

namespace {

SkySource::Cell ancestor(const SkySource::Cell& cell, std::uint32_t level) {
    const std::uint32_t in_level = 1u << (2 * cell.level);
    const std::uint32_t own = cell.index - (cell.lower ? in_level : 0);
    SkySource::Cell out = cell;
    out.level = level;
    out.index = (own >> (2 * (cell.level - level))) + (cell.lower ? 1u << (2 * level) : 0);
    return out;
}

}  // namespace

Vec3 SkySource::vector(const Cell& cell) const {
    if (cell.level <= finest_) return nodes_[at(cell)].luminance;
    return nodes_[at(ancestor(cell, finest_))].luminance /
           double(1u << (2 * (cell.level - finest_)));
}

Vec3 SkySource::vector(const Cell& cell, std::size_t band) const {
    if (cell.level <= finest_) return vectors_[at(cell) * bands_ + band];
    return vectors_[at(ancestor(cell, finest_)) * bands_ + band] /
           double(1u << (2 * (cell.level - finest_)));
}

SkySource::Cone SkySource::cone(const Cell& cell) const {
    const Node& node = nodes_[at(cell.level <= finest_ ? cell : ancestor(cell, finest_))];
    return {node.axis, node.sine};
}

double SkySource::irradiance(const Vec3& normal) const {
    double sum = 0;
    const auto visit = [&](const auto& self, const Cell& cell) -> void {
        const Cone c = cone(cell);
        const double facing = dot(c.axis, normal);
        if (facing <= -c.sine && c.sine < 1) return;
        if ((facing >= c.sine && c.sine < 1) || cell.level == finest_) {
            sum += std::max(0.0, dot(vector(cell), normal));
            return;
        }
        for (std::uint32_t k = 0; k < 4; ++k) self(self, cell.child(k));
    };
    for (const Cell& root : roots()) visit(visit, root);
    return sum;
}

}  // namespace exitance
