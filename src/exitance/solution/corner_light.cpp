// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/corner_light.h"

namespace exitance {

namespace {

// Cosine between normals of surfaces that lie in one plane.
constexpr float same_direction = 0.999f;
// A corner with less than this share of the light of the brightest may be behind something.
constexpr float dark_share = 0.5f;
// Whether it is, is looked for so far above the surface, in terms of the way between the corners.
constexpr double lift = 0.01;

}  // namespace

CornerLight::CornerLight(const Radiosity& radiosity, std::span<const float> unshot,
                         std::span<const ElementId> leaves)
    : radiosity_(radiosity), stride_(radiosity.columns.stride + (unshot.empty() ? 0 : 1)) {
    if (!unshot.empty()) append_column(unshot);
    if (any_buried()) fill_buried(leaves);
}

std::span<const float> CornerLight::operator[](VertexId v) const {
    if (!radiosity_.exposed[v.index()]) return {&buried_[v.index() * stride_], stride_};
    if (rows_.empty()) return radiosity_.irradiance[v];
    return {&rows_[v.index() * stride_], stride_};
}

CornerLight::Corners CornerLight::corners_behind(const Element& leaf,
                                                 std::vector<float>& before) const {
    const Mesh& mesh = radiosity_.mesh;
    const auto corners = leaf.corners();
    std::array<float, 4> level{};
    std::size_t brightest = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        level[i] =
            radiosity_.columns.luminance((*this)[corners[i]].first(radiosity_.columns.stride));
        if (level[i] > level[brightest]) brightest = i;
    }
    const VertexId bright = corners[brightest];
    const auto hidden = [&](const Vec3& place) {
        const Vec3 from = mesh[bright].sample;
        const Vec3 up = Vec3(mesh[bright].normal) *
                        (lift * length(place - from) + radiosity_.caster.clearance());
        return radiosity_.caster.occluded(from + up, place + up);
    };
    Corners behind;
    Vec3 middle;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 place = mesh[corners[i]].sample;
        middle += place / static_cast<double>(corners.size());
        if (level[i] < dark_share * level[brightest] && hidden(place))
            behind.at[behind.count++] = corners[i];
    }
    // If most of the leaf is behind, it is drawn as it is there.
    if (behind.count == 0 || hidden(middle)) return {};
    before.assign(stride_, 0.0f);
    const float share = 1.0f / static_cast<float>(corners.size() - behind.count);
    for (const VertexId v : corners) {
        if (behind.contains(v)) continue;
        const auto row = (*this)[v];
        for (std::size_t c = 0; c < stride_; ++c) before[c] += share * row[c];
    }
    return behind;
}

// What is unshot is interpolated as the light is.
void CornerLight::append_column(std::span<const float> unshot) {
    rows_.resize(unshot.size() * stride_);
    for (std::size_t v = 0; v < unshot.size(); ++v) {
        const auto H = radiosity_.irradiance[VertexId(v)];
        std::copy(H.begin(), H.end(), &rows_[v * stride_]);
        rows_[v * stride_ + stride_ - 1] = unshot[v];
    }
}

// Irradiance of vertices that lie under other objects: from the exposed corners next to them,
// ring by ring, so that no dark fringe surrounds what stands on a surface.
void CornerLight::fill_buried(std::span<const ElementId> leaves) {
    const std::size_t stride = stride_, count = radiosity_.mesh.vertices().size();
    buried_.assign(count * stride, 0.0f);
    std::vector<char> known = radiosity_.exposed;
    take_from_across(known);
    std::vector<ElementId> open(leaves.begin(), leaves.end());
    for (bool found = true; found;) {
        std::vector<std::uint32_t> neighbours(count, 0);
        std::vector<ElementId> rest;
        for (const ElementId leaf : open) {
            const auto corners = radiosity_.mesh[leaf].corners();
            const auto is_known = [&](VertexId v) { return known[v.index()] != 0; };
            if (std::all_of(corners.begin(), corners.end(), is_known)) continue;
            rest.push_back(leaf);
            for (const VertexId v : corners)
                for (const VertexId w : corners) {
                    if (is_known(v) || !is_known(w)) continue;
                    ++neighbours[v.index()];
                    const auto H = (*this)[w];
                    for (std::size_t c = 0; c < stride; ++c)
                        buried_[v.index() * stride + c] += H[c];
                }
        }
        found = false;
        for (std::size_t v = 0; v < count; ++v) {
            if (neighbours[v] == 0) continue;
            for (std::size_t c = 0; c < stride; ++c)
                buried_[v * stride + c] /= static_cast<float>(neighbours[v]);
            known[v] = 1;
            found = true;
        }
        open = std::move(rest);
    }
}

// Where a surface is cut along what stands on it, the two sides have vertices of their own:
// those under it take what those outside have, or its outline is dotted with dark pixels.
void CornerLight::take_from_across(std::vector<char>& known) {
    std::vector<VertexId> open;
    for (std::size_t v = 0; v < known.size(); ++v)
        if (known[v]) open.push_back(VertexId(v));
    const auto place = [&](VertexId v) { return radiosity_.mesh[v].position.value; };
    const auto before = [&](VertexId a, VertexId b) { return place(a) < place(b); };
    std::stable_sort(open.begin(), open.end(), before);
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i]) continue;
        const VertexId v(i);
        const auto [begin, end] = std::equal_range(open.begin(), open.end(), v, before);
        float found = 0;
        for (auto w = begin; w != end; ++w) {
            if (dot(radiosity_.mesh[*w].normal, radiosity_.mesh[v].normal) < same_direction)
                continue;
            ++found;
            for (std::size_t c = 0; c < stride_; ++c) buried_[i * stride_ + c] += (*this)[*w][c];
        }
        for (std::size_t c = 0; c < stride_; ++c) buried_[i * stride_ + c] /= std::max(found, 1.0f);
        known[i] = found > 0;
    }
}

bool CornerLight::any_buried() const {
    for (const char open : radiosity_.exposed)
        if (!open) return true;
    return false;
}

}  // namespace exitance
