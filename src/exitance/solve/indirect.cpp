// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/indirect.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>

#include "exitance/solve/place_on_face.h"
#include "exitance/solve/refine.h"

namespace exitance {

namespace {

// Of the tolerance: what the noise of a gather may be, and how far the middle of an element may be
// from interpolation.
constexpr float noise_share = 0.5f, threshold = 0.5f;
// What noise explains is no reason to divide.
constexpr float noise_deviations = 1.5;
// Vertices of small elements may be noisier, too, within reason.
constexpr float most_noisy = 1.5f;
// Patches are divided this often at most: what is reflected is known in cells of an eighth of a
// patch (reflected_light.cpp), and points closer to one see its edges.
constexpr int most_levels = 4;
constexpr std::size_t batch_size = 4096;

// Key of the directions of rays, the same all over a smooth surface: what they miss by then differs
// little from one vertex to the next, where noise of its own in each would be seen as blotches.
std::uint32_t directions_of(const Face& face) {
    return face.smooth;
}

}  // namespace

IndirectLight::IndirectLight(Radiosity& radiosity, ReflectedLight& source,
                             const IndirectOptions& options)
    : irradiance(0, radiosity.columns.count),
      radiosity_(radiosity),
      source_(source),
      options_(options) {
    admit_new_vertices();
    for (const Patch& patch : radiosity.mesh.patches()) {
        if (!radiosity.black_lamp()[radiosity.mesh[patch.face].polygon.index()] &&
            shown(radiosity.mesh[patch.root].patch) > 0)
            open_.push_back(patch.root);
        else  // nobody asks for the light that they receive
            radiosity.mesh.for_leaves(patch.root, [&](ElementId id) {
                for (const VertexId v : radiosity.mesh[id].corners()) known_[v.index()] = 1;
            });
    }
    if (options_.shown.empty()) return;
    for (const ElementId root : open_)  // but what they share with others is asked for
        radiosity.mesh.for_leaves(root, [&](ElementId id) {
            for (const VertexId v : radiosity.mesh[id].corners()) known_[v.index()] = 0;
        });
}

// The first complete solution: each vertex has what its patches get, on average.
void IndirectLight::spread_patches(std::size_t first) {
    const Mesh& mesh = radiosity_.mesh;
    std::vector<float> weight(mesh.vertices().size(), 0.0f);
    const auto for_corners = [&](const auto& visit) {
        for (std::size_t p = 0; p < mesh.patches().size(); ++p)
            mesh.for_leaves(mesh.patches()[p].root, [&](ElementId id) {
                for (const VertexId v : mesh[id].corners())
                    if (v.index() >= first && radiosity_.exposed[v.index()])
                        visit(p, v, mesh[id].area);
            });
    };
    for_corners([&](std::size_t, VertexId v, float area) { weight[v.index()] += area; });
    for_corners([&](std::size_t p, VertexId v, float area) {
        const auto from = source_.irradiance()[RowId(p)];
        const auto to = irradiance[v];
        for (std::size_t c = 0; c < to.size(); ++c) to[c] += area / weight[v.index()] * from[c];
    });
}

void IndirectLight::admit_new_vertices() {
    const std::size_t first = known_.size();
    make_room();
    spread_patches(first);
}

void IndirectLight::make_room() {
    const std::size_t count = radiosity_.receivers.size();
    irradiance.resize_rows(count);
    variance.resize(count, 0.0f);
    known_.resize(count, 0);
    inverse_distance_.resize(count, 0.0f);
}

void IndirectLight::set_tolerance(float tolerance, float min_area) {
    options_.tolerance = tolerance, options_.min_area = min_area;
    source_.calibrate(noise_share * tolerance);
}

float IndirectLight::light(VertexId v) const {
    return radiosity_.columns.luminance(irradiance[v]);
}

float IndirectLight::shown(PatchId patch) const {
    return options_.shown.empty() ? 1.0f : options_.shown[patch.index()];
}

float IndirectLight::base_tolerance(const Element& element) const {
    return options_.tolerance / shown(element.patch);
}

float IndirectLight::tolerance(const Element& element) const {
    return tolerance_of(base_tolerance(element), options_.area, element.area);
}

std::uint32_t IndirectLight::rays_for(const Element& element) const {
    const float allowed = std::min(tolerance(element), most_noisy * base_tolerance(element));
    return source_.rays_for(element.patch, noise_share * allowed);
}

bool IndirectLight::may_be_divided(const Element& element) const {
    return options_.adaptive && element.area > options_.min_area && element.level < most_levels;
}

// Which elements are to be tested, and which are rough without.
void IndirectLight::sort_out(std::vector<ElementId>& tested, std::vector<ElementId>& rough) {
    for (const ElementId id : open_) {
        const Element& element = radiosity_.mesh[id];
        std::uint32_t exposed = 0;
        for (const VertexId v : element.corners()) exposed += radiosity_.exposed[v.index()] ? 1 : 0;
        if (exposed == element.count) {
            if (worth_testing(element))
                tested.push_back(id);
            else
                closed_.push_back({id});
        } else if (!element.leaf()) {
            rough.push_back(id);
        } else if (exposed > 0) {
            // An object stands on the element: only small elements may be half covered.
            float high = 0;
            for (const VertexId v : element.corners()) high = std::max(high, light(v));
            if (high > base_tolerance(element))
                rough.push_back(id);
            else
                closed_.push_back({id});
        }
    }
}

bool IndirectLight::step() {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    if (open_.empty() || !gather_corners(open_)) return false;
    std::vector<ElementId> tested, rough, next;
    sort_out(tested, rough);
    const Tests tests = tests_of(tested);
    std::vector<std::uint32_t> rays;
    for (const Test& test : tests.at) rays.push_back(test.rays);
    Received received;
    received.reset(tests.points.size(), stride);
    std::vector<Surroundings> around(tests.points.size());
    rays_ += source_.gather(tests.points, rays, received, around);

    for (std::size_t i = 0; i < tests.expected.size();) {
        const ElementId id = tests.expected[i].element;
        bool smooth = true;
        std::span<const float> middle;
        for (; i < tests.expected.size() && tests.expected[i].element == id; ++i) {
            const Expected& expected = tests.expected[i];
            // What lies there buried says nothing of the light.
            smooth = smooth && !(around[expected.test].backs > 0.5f) &&
                     !fails(expected, tests.at[expected.test], received.light[expected.test]);
            if (expected.middle) middle = received.row(expected.test, stride);
        }
        if (smooth)
            close(id, middle);
        else
            rough.push_back(id);
    }
    divide(rough);
    for (std::size_t i = 0; i < tests.at.size(); ++i) {
        const Test& test = tests.at[i];
        const auto v = mesh.find_vertex(mesh[test.face], test.place[0], test.place[1]);
        if (v) know(*v, received.row(i, stride), test.deviation, around[i].inverse_distance);
    }
    for (const ElementId id : rough) {
        if (mesh[id].leaf()) continue;
        for (std::uint32_t c = 0; c < 4; ++c)
            next.push_back(ElementId(mesh[id].first_child.index() + c));
    }
    open_ = std::move(next);
    return !open_.empty();
}

void IndirectLight::know(VertexId v, std::span<const float> row, float deviation,
                         float inverse_distance) {
    if (known_[v.index()] || !radiosity_.exposed[v.index()]) return;
    known_[v.index()] = 1;
    std::copy(row.begin(), row.end(), irradiance[v].begin());
    variance[v.index()] = deviation * deviation;
    inverse_distance_[v.index()] = inverse_distance;
}

bool IndirectLight::gather_corners(const std::vector<ElementId>& elements) {
    const Mesh& mesh = radiosity_.mesh;
    const std::size_t stride = radiosity_.columns.stride;
    const Receivers& all = radiosity_.receivers;
    std::vector<char> listed(known_.size(), 0);
    for (std::size_t at = 0; at < elements.size();) {
        Receivers receivers;
        std::vector<VertexId> fresh;
        std::vector<std::uint32_t> rays;
        std::vector<float> deviation;
        for (; at < elements.size() && fresh.size() < batch_size; ++at) {
            const Element& element = mesh[elements[at]];
            for (const VertexId v : element.corners()) {
                if (known_[v.index()] || listed[v.index()] || !radiosity_.exposed[v.index()])
                    continue;
                listed[v.index()] = 1;
                receivers.add(Vec3(all.point(v.index())), Vec3(all.normal(v.index())),
                              directions_of(mesh[mesh[v].face]));
                fresh.push_back(v);
                rays.push_back(rays_for(element));
                deviation.push_back(source_.deviation(element.patch, rays.back()));
            }
        }
        Received received;
        received.reset(receivers.size(), stride);
        std::vector<Surroundings> around(receivers.size());
        rays_ += source_.gather(receivers, rays, received, around);
        for (std::size_t i = 0; i < fresh.size(); ++i)
            know(fresh[i], received.row(i, stride), deviation[i], around[i].inverse_distance);
        if (options_.interrupted && options_.interrupted()) return false;
    }
    return true;
}

// A leaf that may not be divided needs no test.
bool IndirectLight::worth_testing(const Element& element) const {
    if (!element.leaf()) return true;
    return options_.adaptive && element.area > options_.min_area && element.level < Mesh::max_level;
}

// Light bends over lengths like the mean distance of what is seen, the harmonic one (Ward et al.
// 1988): where an element is larger, something touches it, and it is not taken for small.
bool IndirectLight::touched(const Element& element) const {
    float most = 0;
    for (const VertexId v : element.corners()) most = std::max(most, inverse_distance_[v.index()]);
    return std::sqrt(element.area) * most > 1;
}

// The centre of a quad, the middle of the longest side of a triangle, which two triangles share
// where a quad was cut; of what is touched all sides.
IndirectLight::Tests IndirectLight::tests_of(const std::vector<ElementId>& elements) const {
    const Mesh& mesh = radiosity_.mesh;
    Tests out;
    tsl::robin_map<PlaceOnFace, std::uint32_t, HashOfPlace> places;
    for (const ElementId id : elements) {
        const Element& element = mesh[id];
        const FaceId face = mesh[element.patch].face;
        const auto middle = Mesh::midpoints(element);
        std::uint32_t which = 4;
        if (element.count == 3) {
            const auto c = mesh.corners(element);
            double longest = 0;
            for (std::uint32_t i = 0; i < 3; ++i)
                if (const double side = length(c[(i + 1) % 3] - c[i]); side > longest)
                    longest = side, which = i;
        }
        const bool all = touched(element);
        const float allowed = threshold * (all ? base_tolerance(element) : tolerance(element));
        for (std::uint32_t i = 0; i < middle.count; ++i) {
            if (i != which && !all) continue;
            const auto [u, v] = middle.at[i];
            Expected expected{id};
            expected.allowed = allowed;
            const std::uint32_t from = i < element.count ? i : 0;
            const std::uint32_t count = i < element.count ? 2 : element.count;
            for (std::uint32_t k = 0; k < count; ++k) {
                const VertexId corner = element.vertices[(from + k) % element.count];
                const float share = 1.0f / static_cast<float>(count);
                expected.light += share * light(corner);
                expected.variance += share * share * variance[corner.index()];
            }
            expected.middle = i >= element.count;
            const auto [place, fresh] =
                places.insert({{face, u, v}, static_cast<std::uint32_t>(out.points.size())});
            expected.test = place->second;
            out.expected.push_back(expected);
            if (!fresh) continue;
            out.points.add(mesh.sample_point(element, u, v) - radiosity_.caster.middle(),
                           mesh.normal(mesh[face], u, v), directions_of(mesh[face]));
            const std::uint32_t rays = rays_for(element);
            out.at.push_back({face, {u, v}, rays, source_.deviation(element.patch, rays)});
        }
    }
    return out;
}

bool IndirectLight::fails(const Expected& expected, const Test& test, float found) {
    const float noise =
        noise_deviations * noise_deviations * (test.deviation * test.deviation + expected.variance);
    const float departure = found - expected.light;
    return departure * departure > expected.allowed * expected.allowed + noise;
}

void IndirectLight::finish() {
    const std::size_t stride = radiosity_.columns.stride;
    for (const Closed& closed : closed_) {
        std::span<const float> bend;
        if (closed.bend != Closed::none)
            bend = std::span(bends_).subspan(closed.bend * stride, stride);
        interpolate_in(closed.element, bend);
    }
    for (const ElementId id : open_) interpolate_in(id, {});
    if (options_.interrupted && options_.interrupted()) return;
    // What dividing neighbours brought to elements without light at all corners.
    std::vector<ElementId> rest;
    for (const Patch& patch : radiosity_.mesh.patches())
        if (shown(radiosity_.mesh[patch.root].patch) > 0)
            radiosity_.mesh.for_leaves(patch.root, [&](ElementId id) { rest.push_back(id); });
    gather_corners(rest);
}

}  // namespace exitance
