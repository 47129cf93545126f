// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/refine.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/solve/place_on_face.h"
#include "exitance/visibility/exposure.h"

namespace exitance {

namespace {

// Corners that see different shares of the lamps: a shadow boundary runs through the element. Its
// penumbra bends more than corners and midpoints show, so it has the stricter threshold. Elsewhere
// interpolation mostly errs to one side (light is concave over a surface), and a bias comes back
// with every bounce, so the threshold stays well below the tolerance.
constexpr float shadow_difference = 0.02f;
constexpr float shadow_threshold = 0.2f, smooth_threshold = 0.25f;
// Corners that differ by less than this share of the tolerance cannot hide a departure above it,
// unless something small stands between them (which a thorough test looks for).
constexpr float gradient_threshold = 0.5f;
// A thorough test looks at patches and their children whatever their corners say.
constexpr int thorough_level = 1;
// The least side of a long element, in terms of its length, that its smallness is judged by.
constexpr double longest_aspect = 8;
constexpr std::size_t batch_size = 1024;

// What is known of the shooter's light at the corners of an element.
struct Corners {
    float low = INFINITY, high = -INFINITY, mean = 0, variance = 0, most_variance = 0;
    float least_seen = 1, most_seen = 0;
    int open = 0;
};

class Refinement {
  public:
    Refinement(Radiosity& radiosity, const RefineOptions& options, const Illuminate& illuminate)
        : radiosity_(radiosity), options_(options), illuminate_(illuminate) {}

    std::uint64_t run() {
        std::vector<ElementId> open;
        for (const Patch& patch : radiosity_.mesh.patches())
            radiosity_.mesh.for_leaves(patch.root, [&](ElementId id) {
                if (worth_testing(id)) open.push_back(id);
            });
        // A queue, taken in batches so that memory and the time to an interruption stay bounded.
        for (std::size_t done = 0; done < open.size();) {
            const std::size_t end = std::min(open.size(), done + batch_size);
            std::vector<ElementId> batch;
            for (; done < end; ++done)
                if (radiosity_.mesh[open[done]].leaf()) batch.push_back(open[done]);
            test(batch);
            if (options_.interrupted && options_.interrupted()) break;
            std::vector<ElementId> to_split;
            for (const ElementId id : batch)
                if (fails(id)) to_split.push_back(id);
            const std::vector<ElementId> children = split(to_split);
            if (radiosity_.mesh.vertices().size() >= options_.most_vertices) break;
            open.insert(open.end(), children.begin(), children.end());
        }
        return rays_;
    }

  private:
    float light(VertexId v) const { return radiosity_.columns.luminance(radiosity_.irradiance[v]); }

    float tolerance(const Element& element) const {
        return tolerance_of(options_.tolerance / importance(element), options_.area, element.area);
    }

    float importance(const Element& element) const {
        return options_.importance.empty() ? 1.0f : options_.importance[element.patch.index()];
    }

    float gross_departure(const Element& element) const {
        return options_.gross * options_.tolerance / importance(element) *
               std::sqrt(options_.area / element.area);
    }

    Corners corners_of(const Element& element) const {
        Corners out;
        for (const VertexId v : element.corners()) {
            if (!radiosity_.exposed[v.index()]) continue;
            const float here = light(v), seen = radiosity_.seen[v.index()];
            out.low = std::min(out.low, here), out.high = std::max(out.high, here);
            out.least_seen = std::min(out.least_seen, seen);
            out.most_seen = std::max(out.most_seen, seen);
            out.mean += here;
            out.variance += radiosity_.variance[v.index()];
            out.most_variance = std::max(out.most_variance, radiosity_.variance[v.index()]);
            ++out.open;
        }
        if (out.open) out.mean /= static_cast<float>(out.open);
        if (out.open) out.variance /= static_cast<float>(out.open);
        return out;
    }

    // A long element is judged by its length, within reason.
    bool is_small(const Element& element) const {
        if (element.area > options_.min_area) return false;
        const auto corners = radiosity_.mesh.corners(element);
        const double longest = longest_side({corners.data(), element.count});
        const double square = std::min(longest * longest, longest_aspect * double(element.area));
        return square <= 2 * double(options_.min_area);
    }

    bool worth_testing(ElementId id) const {
        const Element& element = radiosity_.mesh[id];
        if (element.level >= Mesh::max_level || !(importance(element) > 0)) return false;
        if (radiosity_.black_lamp()[radiosity_.mesh.face_of(element).polygon.value]) return false;
        const Corners c = corners_of(element);
        if (is_small(element))
            return c.open == static_cast<int>(element.count) &&
                   c.high - c.low > gross_departure(element);
        // Covered at all corners, perhaps by different objects with light between them.
        if (c.open == 0) return options_.thorough && element.level <= thorough_level;
        const float allowed = tolerance(element);
        if (options_.thorough && element.level <= thorough_level && c.high > allowed) return true;
        const bool shadow = c.most_seen - c.least_seen > shadow_difference;
        const float threshold = gradient_threshold * (shadow ? shadow_threshold : smooth_threshold);
        const bool contact = c.open < static_cast<int>(element.count) && c.high > allowed;
        return contact || c.high - c.low > threshold * allowed;
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
                const auto [slot, fresh] =
                    places_.insert({{face_id, u, v}, static_cast<std::uint32_t>(points_.size())});
                if (fresh)
                    points_.add(mesh.sample_point(element, u, v) - radiosity_.caster.middle(),
                                mesh.normal(face, u, v),
                                static_cast<std::uint32_t>(HashOfPlace{}(slot->first)));
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
        const std::size_t stride = radiosity_.columns.stride;
        float departure = 0, most_variance = all.most_variance, least_seen = all.least_seen,
              most_seen = all.most_seen;
        bool covered = all.open < static_cast<int>(element.count), any_open = false;
        for (std::uint32_t i = 0; i < middle.count; ++i) {
            const auto [u, v] = middle.at[i];
            float here, seen, variance;
            bool open;
            if (const auto vertex = mesh.find_vertex(mesh[face_id], u, v)) {
                here = light(*vertex);
                seen = radiosity_.seen[vertex->index()];
                variance = radiosity_.variance[vertex->index()];
                open = radiosity_.exposed[vertex->index()];
            } else {
                const std::uint32_t at = places_.at({face_id, u, v});
                here = radiosity_.columns.luminance(lit_.row(at, stride));
                seen = lit_.seen[at], open = open_[at];
                variance = lit_.variance[at];
            }
            if (!open) {
                covered = true;
                continue;
            }
            any_open = true;
            least_seen = std::min(least_seen, seen), most_seen = std::max(most_seen, seen);
            most_variance = std::max(most_variance, variance);
            // What sampling noise explains is no reason to split.
            const float noise =
                options_.shared_noise ? 0.0f : std::sqrt(variance + 0.5f * all.variance);
            const float found = std::abs(here - expected(element, i, all.mean));
            departure = std::max(departure, found - noise);
        }
        if (options_.shared_noise) departure -= std::sqrt(1.5f * most_variance);
        if (is_small(element)) return departure > gross_departure(element);
        if (all.open == 0) return any_open;
        // An object stands on the element: only small elements may be half covered.
        if (covered && all.high > tolerance(element)) return true;
        const bool shadow = most_seen - least_seen > shadow_difference;
        return departure > tolerance(element) * (shadow ? shadow_threshold : smooth_threshold);
    }

    // Interpolated light at midpoint `i` of an element, from its open corners.
    float expected(const Element& element, std::uint32_t i, float mean) const {
        if (i >= element.count) return mean;
        float sum = 0;
        int open = 0;
        for (const VertexId v : {element.vertices[i], element.vertices[(i + 1) % element.count]}) {
            if (!radiosity_.exposed[v.index()]) continue;
            sum += light(v);
            ++open;
        }
        return open ? sum / static_cast<float>(open) : mean;
    }

    std::vector<ElementId> split(const std::vector<ElementId>& elements) {
        Mesh& mesh = radiosity_.mesh;
        const std::size_t first_new = mesh.vertices().size();
        std::vector<ElementId> done;
        for (const ElementId id : elements) {
            if (!mesh[id].leaf()) continue;  // a neighbour's split took it along
            if (mesh.vertices().size() >= options_.most_vertices) break;
            const auto also = mesh.split(id);
            done.insert(done.end(), also.begin(), also.end());
        }
        radiosity_.admit_new_vertices();

        std::vector<char> lit(mesh.vertices().size() - first_new, 0);
        std::vector<ElementId> children;
        for (const ElementId id : done) {
            const Element element = mesh[id];
            const FaceId face_id = mesh[element.patch].face;
            const auto middle = Mesh::midpoints(element);
            for (std::uint32_t i = 0; i < middle.count; ++i) {
                const auto [u, v] = middle.at[i];
                const VertexId vertex = *mesh.find_vertex(mesh[face_id], u, v);
                if (vertex.index() < first_new || lit[vertex.index() - first_new]) continue;
                const auto at = places_.find({face_id, u, v});
                if (at == places_.end()) continue;
                take(at->second, vertex);
                lit[vertex.index() - first_new] = 1;
            }
            // What the whole had shot, its parts have shot.
            const std::vector<float> record(radiosity_.shot[id].begin(), radiosity_.shot[id].end());
            for (std::size_t c = 0; c < 4; ++c) {
                const ElementId child(element.first_child.index() + c);
                std::copy(record.begin(), record.end(), radiosity_.shot[child].begin());
                children.push_back(child);
            }
        }
        light_the_rest(lit, first_new);
        std::vector<ElementId> open;
        for (const ElementId child : children)
            if (mesh[child].leaf() && worth_testing(child)) open.push_back(child);
        return open;
    }

    void take(std::uint32_t from, VertexId vertex) {
        radiosity_.seen[vertex.index()] = lit_.seen[from];
        radiosity_.variance[vertex.index()] = lit_.variance[from];
        if (radiosity_.exposed[vertex.index()])
            radiosity_.receive(vertex, lit_.row(from, radiosity_.columns.stride));
    }

    // Vertices that the restriction of the quadtree made without a test.
    void light_the_rest(const std::vector<char>& lit, std::size_t first_new) {
        Receivers rest;
        std::vector<VertexId> vertices;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (lit[k]) continue;
            const std::size_t v = first_new + k;
            const Receivers& all = radiosity_.receivers;
            rest.add(Vec3(all.point(v)), Vec3(all.normal(v)), all.key[v]);
            vertices.push_back(VertexId(v));
        }
        lit_.reset(rest.size(), radiosity_.columns.stride);
        rays_ += illuminate_(rest, lit_);
        for (std::size_t k = 0; k < vertices.size(); ++k)
            take(static_cast<std::uint32_t>(k), vertices[k]);
    }

    Radiosity& radiosity_;
    const RefineOptions& options_;
    const Illuminate& illuminate_;

    tsl::robin_map<PlaceOnFace, std::uint32_t, HashOfPlace> places_;
    Receivers points_;
    Received lit_;
    std::vector<char> open_;
    std::uint64_t rays_ = 0;
};

}  // namespace

std::uint64_t refine(Radiosity& radiosity, const RefineOptions& options,
                     const Illuminate& illuminate) {
    return Refinement(radiosity, options, illuminate).run();
}

}  // namespace exitance
