// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/cast_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/run/parallel.h"

namespace exitance {

void Received::reset(std::size_t count, std::size_t stride) {
    rows.assign(count * stride, 0.0f);
    light.assign(count, 0.0f);
    unblocked.assign(count, 0.0f);
    seen.assign(count, 1.0f);
    variance.assign(count, 0.0f);
}

void Received::note_seen() {
    for (std::size_t i = 0; i < light.size(); ++i)
        seen[i] = unblocked[i] > 0 ? light[i] / unblocked[i] : 1.0f;
}

void Received::add(std::span<const std::uint32_t> which, std::span<const ColumnEntry> entries,
                   std::span<const float> row, float level, float magnitude) {
    const std::size_t stride = row.size();
    parallel_for(
        which.size(),
        [&](std::size_t i) {
            const float factor = entries[i].factor;
            if (!(factor > 0)) return;
            const float f = entries[i].received();
            const std::uint32_t r = which[i];
            for (std::size_t c = 0; c < stride; ++c) rows[r * stride + c] += f * row[c];
            light[r] += f * level;
            unblocked[r] += factor * level;
            const float noise = factor * magnitude * entries[i].deviation;
            variance[r] += noise * noise;
        },
        1024);
}

namespace {

// A node may stand for its descendants while that shifts irradiance by less than this share of the
// tolerance.
constexpr float node_share = 0.05f;
// A factor from which on a source fills the view.
constexpr float near_factor = 0.5f;

// Of a small source right above a receiver that faces it.
float rough_factor(const Source& source, const Receivers& receivers, std::uint32_t r) {
    const Vec3f &a = source.corners[0], &c = source.corners[2];
    const float dx = receivers.x[r] - 0.5f * (a.x + c.x);
    const float dy = receivers.y[r] - 0.5f * (a.y + c.y);
    const float dz = receivers.z[r] - 0.5f * (a.z + c.z);
    const float square = dx * dx + dy * dy + dz * dz;
    return source.area / (std::numbers::pi_v<float> * square + 1e-30f);
}

struct Shot {
    const RayCaster& caster;
    const LightSource& source;
    const Receivers& receivers;
    float tolerance;
    const ColumnOptions& options;
    std::size_t stride;
    Received& received;
    std::uint64_t rays = 0;
    std::vector<ColumnEntry> entries{};

    void cast_node(std::size_t at, std::span<const std::uint32_t> which) {
        const LightSource::Node& node = source.nodes[at];
        entries.resize(which.size());
        rays += compute_column(caster, node.source, node.magnitude / tolerance, node.number,
                               receivers, which, options, entries);
        received.add(which, entries, source.row(at, stride), node.luminance, node.magnitude);
    }

    // Near the source, or where it is uneven, receivers go on to the children.
    bool needs_children(const LightSource::Node& node, std::uint32_t r) const {
        const float factor = rough_factor(node.source, receivers, r);
        return factor > near_factor ||
               node.spread * std::min(1.0f, factor) > node_share * tolerance;
    }

    void visit(std::size_t at, std::span<const std::uint32_t> which) {
        const LightSource::Node& node = source.nodes[at];
        if (node.first_child == 0) return cast_node(at, which);
        std::vector<std::uint32_t> near, far;
        for (const std::uint32_t r : which) (needs_children(node, r) ? near : far).push_back(r);
        if (!far.empty()) cast_node(at, far);
        if (near.empty()) return;
        for (std::size_t k = 0; k < 4; ++k) visit(node.first_child + k, near);
    }
};

}  // namespace

bool fills_view(const Source& source, const Receivers& receivers, std::uint32_t receiver) {
    return rough_factor(source, receivers, receiver) > near_factor;
}

std::uint64_t cast_light(const RayCaster& caster, const LightSource& source,
                         const Receivers& receivers, std::span<const std::uint32_t> which,
                         float tolerance, const ColumnOptions& options, std::size_t stride,
                         Received& received) {
    Shot shot{caster, source, receivers, tolerance, options, stride, received};
    if (!which.empty()) shot.visit(0, which);
    return shot.rays;
}

}  // namespace exitance
