// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/luminaire_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

namespace {

// Cells of the opening are integrated by 2 × 2 Gauss points where they are smaller than a share of
// their distance: a quarter of the beam, which must not slip between the points, within these.
// Where they are far smaller their middle will do.
constexpr double largest_share = 0.25, smallest_share = 0.01, far_share = 0.02;
constexpr int deepest = 24;  // halvings

// Angle over which the intensity is above half of its peak, in the half-plane of the peak [rad].
double beam_width(const Photometry& p) {
    const std::size_t n = p.gammas.size();
    const auto peak = static_cast<std::size_t>(
        std::max_element(p.candela.begin(), p.candela.end()) - p.candela.begin());
    const double* row = &p.candela[peak / n * n];
    std::size_t first = peak % n, last = first;
    while (first > 0 && row[first - 1] > row[peak % n] / 2) --first;
    while (last + 1 < n && row[last + 1] > row[peak % n] / 2) ++last;
    // To the next angles on both sides; at a pole the other half-plane goes on.
    const double from = p.gammas[first > 0 ? first - 1 : 0];
    const double to = p.gammas[std::min(last + 1, n - 1)];
    const bool at_pole = first == 0 || (last + 1 == n && p.gammas.back() > 179);
    return (to - from) * (at_pole ? 2 : 1) * std::numbers::pi / 180;
}

}  // namespace

LuminaireSource::LuminaireSource(const Luminaire& luminaire)
    : luminaire_(luminaire),
      near_share_(
          std::clamp(beam_width(*luminaire.photometry) / 4, smallest_share, largest_share)) {
    const LuminousOpening& opening = luminaire.photometry->opening;
    const auto add = [&](const OpeningFacet& from, bool line) {
        std::array<Vec3, 4> c;
        for (std::size_t i = 0; i < 4; ++i)
            c[i] = luminaire.position +
                   luminaire.to_world(from.corners[std::min<std::size_t>(i, from.count - 1)]);
        Facet facet;
        facet.corner = c[0];
        facet.u = c[1] - c[0];
        facet.v = c[3] - c[0];
        facet.uv = c[2] - c[1] - facet.v;
        facet.normal = luminaire.to_world(from.normal);
        facet.middle = facet.at(0.5, 0.5);
        facet.area = from.area;
        facet.is_line = line;
        facets_.push_back(facet);
    };
    for (const OpeningFacet& facet : facets(opening)) add(facet, false);
    for (const Facet& facet : facets_) {
        auto same = std::find_if(planes_.begin(), planes_.end(), [&](const Plane& plane) {
            return dot(plane.normal, facet.normal) > 1 - 1e-12;
        });
        if (same == planes_.end()) same = planes_.insert(same, {facet.normal, 0});
        same->area += facet.area;
    }
    if (!facets_.empty() || !(opening.extent() > 0)) return;
    // What has a length only shines as a line, evenly in all directions round it.
    OpeningFacet line;
    line.count = 4;
    line.corners = {-0.5 * opening.size, 0.5 * opening.size, 0.5 * opening.size,
                    -0.5 * opening.size};
    line.area = opening.extent();
    add(line, true);
}

double LuminaireSource::Facet::jacobian(double s, double t) const {
    if (is_line) return area;
    return length(cross(u + uv * t, v + uv * s));
}

double LuminaireSource::share(const Facet& facet, const Vec3& direction) const {
    if (facet.is_line) return 1 / facet.area;
    const double facing = dot(facet.normal, direction);
    if (facing <= 0) return 0;
    double shown = 0;
    for (const Plane& p : planes_) shown += p.area * std::max(0.0, dot(p.normal, direction));
    return facing / shown;
}

double LuminaireSource::kernel(const Facet& facet, const Vec3& q, const Vec3& point,
                               const Vec3& normal) const {
    const Vec3 way = point - q;
    const double square = dot(way, way), cosine = -dot(way, normal);
    if (!(cosine > 0)) return 0;
    const double distance = std::sqrt(square);
    const Vec3 direction = way / distance;
    const double part = share(facet, direction);
    return part > 0 ? luminaire_.intensity(direction) * part * cosine / (square * distance) : 0;
}

double LuminaireSource::integrate(const Facet& facet, const Vec3& point, const Vec3& normal,
                                  double s0, double s1, double t0, double t1, int depth) const {
    const double s = 0.5 * (s0 + s1), t = 0.5 * (t0 + t1);
    const double along = (s1 - s0) * length(facet.u + facet.uv * t);
    const double across = (t1 - t0) * length(facet.v + facet.uv * s);
    const double distance = length(facet.at(s, t) - point);
    const double longest = std::max(along, across);
    if (longest > near_share_ * distance && depth < deepest) {
        if (along >= across)
            return integrate(facet, point, normal, s0, s, t0, t1, depth + 1) +
                   integrate(facet, point, normal, s, s1, t0, t1, depth + 1);
        return integrate(facet, point, normal, s0, s1, t0, t, depth + 1) +
               integrate(facet, point, normal, s0, s1, t, t1, depth + 1);
    }
    const double cell = (s1 - s0) * (t1 - t0);
    if (longest < std::min(far_share, near_share_ / 4) * distance)
        return cell * facet.jacobian(s, t) * kernel(facet, facet.at(s, t), point, normal);
    constexpr double gauss = 0.288675134594812882;  // 1 / (2 √3)
    double sum = 0;
    for (const double ds : {-gauss, gauss})
        for (const double dt : {-gauss, gauss}) {
            const double a = s + ds * (s1 - s0), b = t + dt * (t1 - t0);
            sum += facet.jacobian(a, b) * kernel(facet, facet.at(a, b), point, normal);
            if (facet.is_line) break;
        }
    return cell * sum / (facet.is_line ? 2 : 4);
}

double LuminaireSource::irradiance(const Vec3& point, const Vec3& normal) const {
    if (facets_.empty()) {
        const Vec3 way = point - luminaire_.position;
        const double square = dot(way, way), cosine = -dot(way, normal);
        if (!(cosine > 0)) return 0;
        const double distance = std::sqrt(square);
        return luminaire_.intensity(way / distance) * cosine / (square * distance);
    }
    double sum = 0;
    for (const Facet& facet : facets_) {
        // Its plane is behind the receiver's, or the receiver behind its own.
        if (!facet.is_line && dot(facet.normal, point - facet.middle) <= 0) continue;
        sum += integrate(facet, point, normal, 0, 1, 0, 1, 0);
    }
    return sum;
}

namespace {

// The entry of cumulative weights that `u` falls into; `u` becomes the place within it, `chance`
// its share.
std::size_t choose(const std::vector<double>& cumulative, double& u, double& chance) {
    const double total = cumulative.back();
    auto chosen = std::upper_bound(cumulative.begin(), cumulative.end(), u * total);
    while (chosen == cumulative.end() || (chosen != cumulative.begin() && *chosen == *(chosen - 1)))
        --chosen;
    const double below = chosen == cumulative.begin() ? 0.0 : *(chosen - 1);
    u = std::clamp((u * total - below) / (*chosen - below), 0.0, 1 - 1e-12);
    chance = (*chosen - below) / total;
    return static_cast<std::size_t>(chosen - cumulative.begin());
}

}  // namespace

void LuminaireSource::look(const Vec3& point, View& view) const {
    view.cumulative.clear();
    double sum = 0;
    for (const Facet& facet : facets_) {
        if (facet.is_line) {
            sum += 1;
        } else {
            const Vec3 way = point - facet.middle;
            const double facing = dot(facet.normal, way), square = dot(way, way);
            if (facing > 0) sum += facet.area * facing / (square * std::sqrt(square));
        }
        view.cumulative.push_back(sum);
    }
}

LuminaireSource::Sample LuminaireSource::sample(const View& view, const Vec3& point,
                                                const Vec3& normal, double u, double v) const {
    if (facets_.empty()) {
        const bool below = dot(point - luminaire_.position, luminaire_.nadir) > 0;
        return {luminaire_.position, below ? luminaire_.nadir : -luminaire_.nadir, 1};
    }
    if (!(view.cumulative.back() > 0)) return {};
    double chance = 1;
    const Facet& facet = facets_[choose(view.cumulative, u, chance)];
    Sample out;
    out.place = facet.at(u, v);
    out.normal = facet.is_line ? normalized(point - out.place) : facet.normal;
    out.weight = facet.jacobian(u, v) * kernel(facet, out.place, point, normal) / chance;
    return out;
}

LuminaireSource::Sample LuminaireSource::sample_along(const Vec3& direction, double u,
                                                      double v) const {
    if (facets_.empty()) {
        const bool below = dot(direction, luminaire_.nadir) > 0;
        return {luminaire_.position, below ? luminaire_.nadir : -luminaire_.nadir, 1};
    }
    std::vector<double> cumulative;
    double sum = 0, chance = 1;
    for (const Facet& facet : facets_)
        cumulative.push_back(
            sum += facet.is_line ? 1.0 : facet.area * std::max(0.0, dot(facet.normal, direction)));
    if (!(sum > 0)) return {luminaire_.position, direction, 0};
    const Facet& facet = facets_[choose(cumulative, u, chance)];
    return {facet.at(u, v), facet.is_line ? direction : facet.normal,
            facet.jacobian(u, v) / facet.area};
}

}  // namespace exitance
