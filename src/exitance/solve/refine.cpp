// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/refine.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>

#include "exitance/run/random.h"
#include "exitance/visibility/exposure.h"

namespace exitance {

namespace {

// Corners that see different shares of the shooter: a shadow boundary runs through the element.
// Its penumbra bends more than corners and midpoints show, so it has the stricter threshold.
constexpr float shadow_difference = 0.02f;
constexpr float shadow_threshold = 0.5f, smooth_threshold = 1.0f;
// Corners that differ by less than this share of the tolerance cannot hide a departure above it,
// unless something small stands between them (which a thorough test looks for).
constexpr float gradient_threshold = 0.5f;

struct Place {
    FaceId face;
    std::int32_t u, v;
    friend bool operator==(const Place&, const Place&) = default;
};

struct PlaceHash {
    std::size_t operator()(const Place& p) const {
        return hash_bits(p.face.value, static_cast<std::uint32_t>(p.u),
                         static_cast<std::uint32_t>(p.v));
    }
};

// What is known of the shooter's light at the corners of an element.
struct Corners {
    float low = INFINITY, high = -INFINITY, mean = 0;
    float least_seen = 1, most_seen = 0;
    int open = 0;
};

class Refinement {
  public:
    Refinement(Radiosity& radiosity, const RefineOptions& options, const Illuminate& illuminate,
               bool interpolate_earlier, Received& received)
        : radiosity_(radiosity),
          options_(options),
          illuminate_(illuminate),
          interpolate_earlier_(interpolate_earlier),
          received_(received) {}

    std::uint64_t run() {
        std::vector<ElementId> open;
        for (const Patch& patch : radiosity_.mesh.patches())
            radiosity_.mesh.for_leaves(patch.root, [&](ElementId id) {
                if (worth_testing(id)) open.push_back(id);
            });
        while (!open.empty()) {
            test(open);
            std::vector<ElementId> to_split;
            for (const ElementId id : open)
                if (fails(id)) to_split.push_back(id);
            open = split(to_split);
        }
        return rays_;
    }

  private:
    Corners corners_of(const Element& element) const {
        Corners out;
        for (const VertexId v : element.corners()) {
            if (!radiosity_.exposed[v.index()]) continue;
            const float light = received_.light[v.index()];
            const float seen = received_.visible(v.index());
            out.low = std::min(out.low, light), out.high = std::max(out.high, light);
            out.least_seen = std::min(out.least_seen, seen);
            out.most_seen = std::max(out.most_seen, seen);
            out.mean += light;
            ++out.open;
        }
        if (out.open) out.mean /= static_cast<float>(out.open);
        return out;
    }

    bool worth_testing(ElementId id) const {
        const Element& element = radiosity_.mesh[id];
        if (element.area <= options_.min_area || element.level >= Mesh::max_level) return false;
        if (!radiosity_.reflects(radiosity_.mesh.face_of(element))) return false;
        const Corners c = corners_of(element);
        if (c.open == 0) return false;
        if (options_.thorough && c.high > options_.tolerance) return true;
        const bool shadow = c.most_seen - c.least_seen > shadow_difference;
        const float threshold = gradient_threshold * (shadow ? shadow_threshold : smooth_threshold);
        return c.high - c.low > threshold * options_.tolerance;
    }

    // Lights the edge midpoints and centres of all elements under test, shared ones once.
    void test(const std::vector<ElementId>& elements) {
        places_.clear();
        points_ = Receivers{};
        const Mesh& mesh = radiosity_.mesh;
        for (const ElementId id : elements) {
            const Element& element = mesh[id];
            const FaceId face_id = mesh[element.patch].face;
            const Face& face = mesh[face_id];
            const auto middle = Mesh::midpoints(element);
            for (std::uint32_t i = 0; i < middle.count; ++i) {
                const auto [u, v] = middle.at[i];
                if (mesh.find_vertex(face, u, v)) continue;
                const auto [slot, fresh] = places_.insert(
                    {{face_id, u, v}, static_cast<std::uint32_t>(points_.size())});
                if (fresh)
                    points_.add(mesh.sample_point(element, u, v) - radiosity_.caster.middle(),
                                mesh.normal(face, u, v),
                                static_cast<std::uint32_t>(PlaceHash{}(slot->first)));
            }
        }
        lit_.reset(points_.size(), radiosity_.columns.stride);
        rays_ += illuminate_(points_, lit_);
        open_.resize(points_.size());
        find_exposed(radiosity_.caster, radiosity_.two_sided(), points_, 0, open_);
        rays_ += points_.size() * RayPacket::width;
    }

    bool fails(ElementId id) const {
        const Mesh& mesh = radiosity_.mesh;
        const Element& element = mesh[id];
        const FaceId face_id = mesh[element.patch].face;
        const auto middle = Mesh::midpoints(element);
        const Corners all = corners_of(element);
        float departure = 0, least_seen = all.least_seen, most_seen = all.most_seen;
        bool covered = all.open < element.count;
        for (std::uint32_t i = 0; i < middle.count; ++i) {
            const auto [u, v] = middle.at[i];
            float light, seen;
            bool open;
            if (const auto vertex = mesh.find_vertex(mesh[face_id], u, v)) {
                light = received_.light[vertex->index()];
                seen = received_.visible(vertex->index());
                open = radiosity_.exposed[vertex->index()];
            } else {
                const std::uint32_t at = places_.at({face_id, u, v});
                light = lit_.light[at], seen = lit_.visible(at), open = open_[at];
            }
            if (!open) {
                covered = true;
                continue;
            }
            least_seen = std::min(least_seen, seen), most_seen = std::max(most_seen, seen);
            departure = std::max(departure, std::abs(light - expected(element, i, all.mean)));
        }
        // An object stands on the element: only small elements may be half covered.
        if (covered && all.high > options_.tolerance) return options_.thorough;
        const bool shadow = most_seen - least_seen > shadow_difference;
        return departure > options_.tolerance * (shadow ? shadow_threshold : smooth_threshold);
    }

    // Interpolated light at midpoint `i` of an element, from its open corners.
    float expected(const Element& element, std::uint32_t i, float mean) const {
        if (i >= element.count) return mean;
        float sum = 0;
        int open = 0;
        for (const VertexId v : {element.vertices[i], element.vertices[(i + 1) % element.count]}) {
            if (!radiosity_.exposed[v.index()]) continue;
            sum += received_.light[v.index()];
            ++open;
        }
        return open ? sum / static_cast<float>(open) : mean;
    }

    std::vector<ElementId> split(const std::vector<ElementId>& elements) {
        Mesh& mesh = radiosity_.mesh;
        const std::size_t stride = radiosity_.columns.stride;
        const std::size_t first_new = mesh.vertices().size();
        std::vector<ElementId> done;
        for (const ElementId id : elements) {
            if (!mesh[id].leaf()) continue;  // a neighbour's split took it along
            const auto also = mesh.split(id);
            done.insert(done.end(), also.begin(), also.end());
        }
        radiosity_.admit_new_vertices();
        const std::size_t count = mesh.vertices().size();
        received_.rows.resize(count * stride, 0.0f);
        received_.light.resize(count, 0.0f);
        received_.unblocked.resize(count, 0.0f);

        std::vector<char> known(count - first_new, 0);
        std::vector<ElementId> children;
        for (const ElementId id : done) {
            const Element element = mesh[id];
            const FaceId face_id = mesh[element.patch].face;
            const auto middle = Mesh::midpoints(element);
            for (std::uint32_t i = 0; i < middle.count; ++i) {
                const auto [u, v] = middle.at[i];
                const VertexId vertex = *mesh.find_vertex(mesh[face_id], u, v);
                if (vertex.index() < first_new || known[vertex.index() - first_new] == 2) continue;
                if (interpolate_earlier_ && known[vertex.index() - first_new] == 0)
                    inherit(element, i, vertex);
                known[vertex.index() - first_new] = 1;
                const auto at = places_.find({face_id, u, v});
                if (at == places_.end()) continue;
                copy(at->second, vertex);
                known[vertex.index() - first_new] = 2;
            }
            for (std::size_t c = 0; c < 4; ++c) {
                const ElementId child(element.first_child.index() + c);
                const auto from = radiosity_.shot[id];
                std::copy(from.begin(), from.end(), radiosity_.shot[child].begin());
                children.push_back(child);
            }
        }
        light_the_rest(known, first_new);
        std::vector<ElementId> open;
        for (const ElementId child : children)
            if (mesh[child].leaf() && worth_testing(child)) open.push_back(child);
        return open;
    }

    // The sum of all earlier shooters at a new vertex, interpolated from its parents.
    void inherit(const Element& element, std::uint32_t i, VertexId vertex) {
        if (!radiosity_.exposed[vertex.index()]) return;
        std::vector<float> sum(radiosity_.columns.stride, 0.0f);
        int open = 0;
        const auto add = [&](VertexId v) {
            if (!radiosity_.exposed[v.index()]) return;
            const auto row = radiosity_.irradiance[v];
            for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += row[c];
            ++open;
        };
        if (i < element.count) {
            add(element.vertices[i]);
            add(element.vertices[(i + 1) % element.count]);
        }
        if (open == 0)
            for (const VertexId v : element.corners()) add(v);
        if (open == 0) return;
        for (float& value : sum) value /= static_cast<float>(open);
        radiosity_.receive(vertex, sum);
    }

    void copy(std::uint32_t from, VertexId vertex) {
        const std::size_t stride = radiosity_.columns.stride, to = vertex.index();
        std::copy_n(&lit_.rows[from * stride], stride, &received_.rows[to * stride]);
        received_.light[to] = lit_.light[from];
        received_.unblocked[to] = lit_.unblocked[from];
    }

    // Vertices that the restriction of the quadtree made without a test.
    void light_the_rest(const std::vector<char>& known, std::size_t first_new) {
        Receivers rest;
        std::vector<VertexId> vertices;
        for (std::size_t k = 0; k < known.size(); ++k) {
            if (known[k] == 2) continue;
            const std::size_t v = first_new + k;
            const Receivers& all = radiosity_.receivers;
            rest.add({all.x[v], all.y[v], all.z[v]}, {all.nx[v], all.ny[v], all.nz[v]}, all.key[v]);
            vertices.push_back(VertexId(v));
        }
        lit_.reset(rest.size(), radiosity_.columns.stride);
        rays_ += illuminate_(rest, lit_);
        for (std::size_t k = 0; k < vertices.size(); ++k)
            copy(static_cast<std::uint32_t>(k), vertices[k]);
    }

    Radiosity& radiosity_;
    const RefineOptions& options_;
    const Illuminate& illuminate_;
    bool interpolate_earlier_;
    Received& received_;

    tsl::robin_map<Place, std::uint32_t, PlaceHash> places_;
    Receivers points_;
    Received lit_;
    std::vector<char> open_;
    std::uint64_t rays_ = 0;
};

}  // namespace

std::uint64_t refine(Radiosity& radiosity, const RefineOptions& options,
                     const Illuminate& illuminate, bool interpolate_earlier, Received& received) {
    return Refinement(radiosity, options, illuminate, interpolate_earlier, received).run();
}

}  // namespace exitance
