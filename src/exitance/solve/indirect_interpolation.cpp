// SPDX-License-Identifier: Apache-2.0
// Reflected light where it is not gathered.
#include <algorithm>

#include "exitance/solve/indirect.h"

namespace exitance {

namespace {

// Weights of the corners of `whole` at (u, v): bilinear in a quad, barycentric in a triangle.
std::array<float, 4> weights_at(const Element& whole, std::int32_t u, std::int32_t v) {
    const float s = static_cast<float>(u - whole.u) / static_cast<float>(whole.size);
    const float t = static_cast<float>(v - whole.v) / static_cast<float>(whole.size);
    if (whole.count == 3) return {1 - s - t, s, t, 0};
    return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

std::array<std::array<std::int32_t, 2>, 4> corners_of(const Element& e) {
    if (e.count == 3) return {{{e.u, e.v}, {e.u + e.size, e.v}, {e.u, e.v + e.size}, {e.u, e.v}}};
    return {{{e.u, e.v}, {e.u + e.size, e.v}, {e.u + e.size, e.v + e.size}, {e.u, e.v + e.size}}};
}

}  // namespace

void IndirectLight::divide(const std::vector<ElementId>& elements) {
    Mesh& mesh = radiosity_.mesh;
    const std::size_t known = mesh.vertices().size();
    std::vector<ElementId> divided;
    for (const ElementId id : elements) {
        if (!mesh[id].leaf() || !may_be_divided(mesh[id])) continue;
        if (mesh.vertices().size() >= options_.most_vertices) break;
        const auto done = mesh.split(id);
        divided.insert(divided.end(), done.begin(), done.end());
    }
    radiosity_.admit_new_vertices();
    make_room();
    std::vector<char> lit(mesh.vertices().size() - known, 0);
    for (const ElementId id : divided) {
        const Element& whole = mesh[id];
        for (std::size_t c = 0; c < 4; ++c) {
            const ElementId child_id(whole.first_child.index() + c);
            // What the whole has shot, its parts have shot.
            std::copy_n(radiosity_.shot[id].data(), radiosity_.shot.stride(),
                        radiosity_.shot[child_id].data());
            const Element& child = mesh[child_id];
            const auto places = corners_of(child);
            for (std::uint32_t i = 0; i < child.count; ++i) {
                const VertexId v = child.vertices[i];
                if (v.index() < known || lit[v.index() - known]) continue;
                lit[v.index() - known] = 1;
                interpolate(whole, places[i], v);
            }
        }
    }
}

// The four sides of a quad stay straight, and so do those of a triangle that is no half of one.
void IndirectLight::close(ElementId id, std::span<const float> middle) {
    const Element& element = radiosity_.mesh[id];
    if (element.leaf()) return;
    Closed closed{id};
    if (!middle.empty()) {
        const std::size_t stride = middle.size();
        closed.bend = static_cast<std::uint32_t>(bends_.size() / stride);
        for (std::size_t c = 0; c < stride; ++c) {
            float mean = 0;
            for (const VertexId v : element.corners()) mean += 0.25f * irradiance[v][c];
            bends_.push_back(middle[c] - mean);
        }
    }
    closed_.push_back(closed);
}

// From those corners that are open to the room; where none is, nothing is known.
void IndirectLight::interpolate(const Element& whole, const std::array<std::int32_t, 2>& place,
                                VertexId to) {
    auto weight = weights_at(whole, place[0], place[1]);
    float sum = 0;
    for (std::uint32_t c = 0; c < whole.count; ++c)
        sum += weight[c] *= radiosity_.exposed[whole.vertices[c].index()] ? 1.0f : 0.0f;
    if (!(sum > 0) || !radiosity_.exposed[to.index()]) return;
    const auto row = irradiance[to];
    std::fill(row.begin(), row.end(), 0.0f);
    variance[to.index()] = 0;
    for (std::uint32_t c = 0; c < whole.count; ++c) {
        const float w = weight[c] / sum;
        const auto corner = irradiance[whole.vertices[c]];
        for (std::size_t k = 0; k < row.size(); ++k) row[k] += w * corner[k];
        variance[to.index()] += w * w * variance[whole.vertices[c].index()];
    }
}

// A bend is a bubble over a quad, 16 s (1 - s) t (1 - t) of it.
void IndirectLight::interpolate_in(ElementId id, std::span<const float> bend) {
    const Mesh& mesh = radiosity_.mesh;
    const Element& whole = mesh[id];
    if (whole.leaf()) return;
    for (const VertexId v : whole.corners())
        if (!known_[v.index()]) return;
    mesh.for_leaves(id, [&](ElementId leaf) {
        const Element& element = mesh[leaf];
        const auto places = corners_of(element);
        for (std::uint32_t i = 0; i < element.count; ++i) {
            const VertexId v = element.vertices[i];
            if (known_[v.index()] || !radiosity_.exposed[v.index()]) continue;
            known_[v.index()] = 1;
            interpolate(whole, places[i], v);
            if (bend.empty()) continue;
            const auto w = weights_at(whole, places[i][0], places[i][1]);
            const float bubble = 16 * (w[0] + w[3]) * (w[1] + w[2]) * (w[0] + w[1]) * (w[2] + w[3]);
            const auto row = irradiance[v];
            for (std::size_t c = 0; c < bend.size(); ++c)
                row[c] = std::max(0.0f, row[c] + bubble * bend[c]);
        }
    });
}

}  // namespace exitance
