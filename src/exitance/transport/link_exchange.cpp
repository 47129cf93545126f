// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/link_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/far_exchange.h"
#include "exitance/formfactor/point_polygon.h"
#include "exitance/formfactor/polygon_polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::size_t most_places = Cluster::places_count;
// Elements nearer than so many sums of their radii get the exact double integral: beyond, four
// Gauss points on one and the exact factor from there to the other, both ways, do.
constexpr double near = 1;
// Clusters whose spheres are this much apart, in sums of their radii, are measured by their places.
constexpr double apart = 1.2;
// So many blockers in a shaft: rays are cheaper than a look at each.
constexpr std::size_t most_blockers = 24;
// Of what looks unblocked or blocked by n stratified rays, what they may have missed: half the
// share of one.
constexpr double missed_share = 0.5;

Box scaled(const Box& box, const Vec3& middle, double scale) {
    return {(box.lower - middle) / scale, (box.upper - middle) / scale};
}

}  // namespace

// A node as one end of a link.
struct LinkExchange::End {
    struct Place {
        Vec3 at, normal;
        const Face* face = nullptr;
        double share = 0;  ///< of the area; they sum to 1
    };

    NodeId node;
    bool element = false, whole = true;  ///< whole: all of it is open, and its own
    Box box;
    Vec3 centre;
    double radius = 0, area = 0;
    std::optional<Plane> plane;
    std::array<Vec3, 4> outline{};
    std::uint32_t corners = 0;
    std::array<Place, most_places> places{};
    std::size_t count = 0;

    std::span<const Vec3> polygon() const { return {outline.data(), corners}; }

    // Whether nothing of it is before the plane.
    bool is_behind(const Plane& other, double slack) const {
        if (element)
            return std::all_of(outline.begin(), outline.begin() + corners,
                               [&](const Vec3& p) { return other.height(p) <= slack; });
        const Vec3 half = box.size() * 0.5;
        const Vec3& n = other.normal;
        const double reach =
            std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
        return other.height(box.centre()) + reach <= slack;
    }

    // Spread evenly instead of at Gauss points.
    void spread_places(std::uint64_t key) {
        if (!element) return;
        const Place like = places[0];
        count = most_places;
        for (std::uint32_t k = 0; k < count; ++k) {
            places[k] = like;
            places[k].at = uniform_polygon(polygon(), low_discrepancy(key, k));
            places[k].share = 1.0 / double(count);
        }
    }
};

// Two ends as their places see each other.
struct LinkExchange::Look {
    using Matrix = std::array<std::array<double, most_places>, most_places>;
    /// What the places of one end see of the other.
    struct Seen {
        std::array<double, most_places> factor{};   ///< nothing between
        std::array<double, most_places> visible{};  ///< share of it
        Seen() { visible.fill(1.0); }
    };

    Matrix kernel{};   ///< cosθ₁ cosθ₂ / π r²
    Matrix through{};  ///< 0 hidden … 1 seen, where rays were cast
    Seen of_a, of_b;
    double share = 1;   ///< of all that is seen
    bool agree = true;  ///< all rays found the same
    std::uint64_t rays = 0;

    Look(const End& a, const End& b, bool near_clusters);
    /// Shares from the rays.
    void weigh(const End& a, const End& b);
    /// What rays that agree may have missed, as a share.
    double missed() const { return agree && rays > 0 ? missed_share / double(rays) : 0.0; }
};

LinkExchange::LinkExchange(const ElementScene& scene, const Clusters& clusters, std::uint64_t seed)
    : scene_(scene), clusters_(clusters), seed_(seed) {
    Box bounds;
    for (const Vec3& p : scene.mesh.positions()) bounds.add(p);
    if (bounds.empty()) return;
    scale_ = bounds.diagonal() > 0 ? bounds.diagonal() : 1.0;
    middle_ = bounds.centre();
    // Glass is told by rays: they know how much it lets through.
    if (scene.caster.has_glass()) return;
    std::vector<SmallPolygon> outlines;
    for (const Face& face : scene.mesh.faces()) {
        if (face.back) continue;
        const auto corners = scene.mesh.corners(face);
        outlines.emplace_back();
        for (std::uint32_t c = 0; c < face.count; ++c)
            outlines.back().add((corners[c] - middle_) / scale_);
    }
    std::vector<std::span<const Vec3>> polygons;
    for (const SmallPolygon& outline : outlines) polygons.push_back(outline.corners());
    blockers_ = find_blockers(polygons);
    std::vector<Box> boxes;
    for (const Blocker& blocker : blockers_) boxes.push_back(blocker.bounds);
    if (!boxes.empty()) tree_.emplace_back(boxes);
}

LinkExchange::End LinkExchange::end_of(NodeId node, double open) const {
    End end;
    end.node = node;
    const Mesh& mesh = scene_.mesh;
    if (clusters_.is_cluster(node)) {
        const Cluster& cluster = clusters_.cluster(node);
        end.box = cluster.box;
        end.centre = cluster.box.centre();
        end.radius = 0.5 * cluster.box.diagonal();
        end.area = cluster.area;
        end.plane = cluster.plane;
        end.count = cluster.places.size();
        for (std::size_t k = 0; k < end.count; ++k) {
            const Face& face = mesh[cluster.places[k].face];
            end.places[k] = {cluster.places[k].at, face.normal, &face, 1.0 / double(end.count)};
        }
    } else {
        const Element& element = mesh[clusters_.element(node)];
        const Face& face = mesh.face_of(element);
        end.element = true;
        end.outline = mesh.corners(element);
        end.corners = element.count;
        const SampledFacet facet(end.polygon());
        for (const Vec3& p : end.polygon()) end.box.add(p);
        end.centre = facet.centre;
        end.radius = facet.radius;
        end.area = double(element.area);
        end.plane = facet.plane;
        end.count = facet.points.size();
        for (std::size_t k = 0; k < end.count; ++k)
            end.places[k] = {facet.points[k], face.normal, &face, facet.weights[k] / facet.area};
    }
    end.whole = open >= (1 - 1e-5) * end.area;
    return end;
}

Meeting LinkExchange::between(const End& a, const End& b) const {
    if (!a.whole || !b.whole || scene_.caster.has_glass()) return Meeting::partly;
    if (tree_.empty()) return Meeting::seen;
    const Box box_a = scaled(a.box, middle_, scale_), box_b = scaled(b.box, middle_, scale_);
    const Shaft shaft(box_a, box_b);
    std::size_t met = 0;
    bool hidden = false;
    tree_[0].for_accepted([&](const Box& box) { return !shaft.misses(box); },
                          [&](std::uint32_t i) {
                              hidden = hides(blockers_[i], box_a, box_b);
                              return !hidden && ++met < most_blockers;
                          });
    return hidden ? Meeting::none : met > 0 ? Meeting::partly : Meeting::seen;
}

LinkExchange::Look::Look(const End& a, const End& b, bool near_clusters) {
    for (std::size_t i = 0; i < a.count; ++i)
        for (std::size_t j = 0; j < b.count; ++j) {
            const End::Place &p = a.places[i], &q = b.places[j];
            const Vec3 d = q.at - p.at;
            const double r2 = dot(d, d), up = dot(d, p.normal), down = -dot(d, q.normal);
            if (!(up > 0 && down > 0)) continue;
            // Places that are near stand for discs (Wallace et al. 1989), not for points.
            const double disc = near_clusters ? std::min(p.share * a.area, q.share * b.area) : 0.0;
            kernel[i][j] = up * down / (r2 * (std::numbers::pi * r2 + disc));
            of_a.factor[i] += kernel[i][j] * q.share * b.area;
            of_b.factor[j] += kernel[i][j] * p.share * a.area;
        }
    // The exact factor where an end is a polygon.
    for (std::size_t i = 0; b.element && i < a.count; ++i)
        of_a.factor[i] = point_polygon_factor(a.places[i].at, a.places[i].normal, b.polygon());
    for (std::size_t j = 0; a.element && j < b.count; ++j)
        of_b.factor[j] = point_polygon_factor(b.places[j].at, b.places[j].normal, a.polygon());
}

void LinkExchange::Look::weigh(const End& a, const End& b) {
    double seen = 0, all = 0;
    std::array<double, most_places> all_a{}, all_b{}, seen_a{}, seen_b{};
    for (std::size_t i = 0; i < a.count; ++i)
        for (std::size_t j = 0; j < b.count; ++j) {
            const double k = kernel[i][j] * a.places[i].share * b.places[j].share;
            const double s = k * through[i][j];
            seen += s, all += k;
            all_a[i] += k, all_b[j] += k;
            seen_a[i] += s, seen_b[j] += s;
        }
    share = all > 0 ? seen / all : 1;
    agree = !(all > 0) || seen <= 0 || seen >= (1 - 1e-6) * all;
    for (std::size_t i = 0; i < a.count; ++i)
        of_a.visible[i] = all_a[i] > 0 ? seen_a[i] / all_a[i] : share;
    for (std::size_t j = 0; j < b.count; ++j)
        of_b.visible[j] = all_b[j] > 0 ? seen_b[j] / all_b[j] : share;
}

void LinkExchange::cast(const End& a, const End& b, Look& look) const {
    const RayCaster& caster = scene_.caster;
    const auto own = [&](const End::Place& place) {
        return scene_.owners.owns(place.face->polygon, place.face->back,
                                  place.at - caster.middle());
    };
    std::array<bool, most_places> own_b{};
    for (std::size_t j = 0; j < b.count; ++j) own_b[j] = own(b.places[j]);
    std::array<std::array<std::size_t, 2>, RayPacket::width> pair{};
    RayPacket rays;
    rays.near.fill(0.0f), rays.far.fill(1.0f);
    std::size_t lane = 0;
    const auto flush = [&] {
        if (lane == 0) return;
        std::array<float, RayPacket::width> through;
        through.fill(1.0f);
        const std::uint32_t blocked =
            caster.has_glass() ? caster.occluded(rays, through) : caster.occluded(rays);
        for (std::size_t k = 0; k < lane; ++k)
            look.through[pair[k][0]][pair[k][1]] = blocked >> k & 1u ? 0.0 : double(through[k]);
        look.rays += lane;
        lane = 0, rays.active = 0;
    };
    for (std::size_t i = 0; i < a.count; ++i) {
        const bool own_a = own(a.places[i]);
        for (std::size_t j = 0; j < b.count; ++j) {
            look.through[i][j] = 0;
            if (!(look.kernel[i][j] > 0) || !own_a || !own_b[j]) continue;
            const Vec3 from = a.places[i].at + a.places[i].normal * caster.clearance();
            const Vec3 to = b.places[j].at + b.places[j].normal * caster.clearance();
            pair[lane] = {i, j};
            rays.aim(lane, from - caster.middle(), to - from);
            if (++lane == RayPacket::width) flush();
        }
    }
    flush();
    look.weigh(a, b);
}

namespace {

// Mean of factor × visible share and its standard deviation over the places of an end.
std::array<double, 2> mean_and_spread(const auto& seen, const auto& end) {
    double mean = 0, square = 0;
    for (std::size_t i = 0; i < end.count; ++i)
        mean += end.places[i].share * seen.factor[i] * seen.visible[i];
    for (std::size_t i = 0; i < end.count; ++i) {
        const double d = seen.factor[i] * seen.visible[i] - mean;
        square += end.places[i].share * d * d;
    }
    return {mean, std::sqrt(square)};
}

void note_departures(const auto& seen, const auto& end,
                     std::array<float, Cluster::places_count>& off) {
    const double mean = mean_and_spread(seen, end)[0];
    for (std::size_t i = 0; i < end.count; ++i)
        off[i] = static_cast<float>(seen.factor[i] * seen.visible[i] - mean);
}

}  // namespace

Meeting LinkExchange::measure(NodeId node_a, NodeId node_b, double open_a, double open_b,
                              Link& link, std::uint64_t& rays) const {
    link = {node_a, node_b};
    if (!(open_a > 0 && open_b > 0)) return Meeting::none;
    End a = end_of(node_a, open_a), b = end_of(node_b, open_b);
    const double slack = 1e-7 * scale_;
    if ((a.plane && b.is_behind(*a.plane, slack)) || (b.plane && a.is_behind(*b.plane, slack)))
        return Meeting::none;
    const Meeting meeting = between(a, b);
    if (meeting == Meeting::none) return meeting;

    const bool polygons = a.element && b.element;
    const double distance = length(a.centre - b.centre), reach = a.radius + b.radius;
    const bool bound = !polygons && distance < apart * reach;
    Look look(a, b, bound);
    // Exchange area with nothing between.
    const double free = polygons && distance < near * reach
                            ? exchange_area(a.polygon(), b.polygon(), 1e-3)
                            : 0.5 * (a.area * mean_and_spread(look.of_a, a)[0] +
                                     b.area * mean_and_spread(look.of_b, b)[0]);
    // Places of a cluster may all look away where some of it does not.
    if (polygons && !(free > 0)) return Meeting::none;
    if (meeting == Meeting::partly) cast(a, b, look);
    rays += look.rays;
    note_departures(look.of_a, a, link.off_a);
    note_departures(look.of_b, b, link.off_b);
    if (!look.agree && (a.element || b.element)) {  // more rays, from more places of elements
        const std::uint64_t key = hash_bits(seed_, node_a.value, node_b.value);
        a.spread_places(key);
        b.spread_places(hash_bits(key));
        look = Look(a, b, bound);
        cast(a, b, look);
        rays += look.rays;
    }
    link.area = static_cast<float>(free * look.share);
    link.bound = bound;
    if (bound) {
        // Too near for places to tell much: F ≤ 1 and A_a F ≤ A_b bound its mean square over a.
        link.area = std::min(link.area, static_cast<float>(std::min(open_a, open_b)));
        link.spread_a = static_cast<float>(std::sqrt(std::min(1.0, b.area / a.area)));
        link.spread_b = static_cast<float>(std::sqrt(std::min(1.0, a.area / b.area)));
        return Meeting::partly;
    }
    const auto spread = [&](const Look::Seen& seen, const End& end) {
        return static_cast<float>(
            std::hypot(mean_and_spread(seen, end)[1], look.missed() * free / end.area));
    };
    link.spread_a = spread(look.of_a, a);
    link.spread_b = spread(look.of_b, b);
    return meeting;
}

std::size_t LinkExchange::bytes() const {
    std::size_t sum = 0;
    for (const Blocker& blocker : blockers_) sum += blocker.bytes();
    return sum;
}

}  // namespace exitance
