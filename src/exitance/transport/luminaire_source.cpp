// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/luminaire_source.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

// Cells of the opening are integrated by 2 × 2 Gauss points where they are smaller than this share
// of their distance, and by their middle where they are far smaller.
constexpr double near_share = 0.25, far_share = 0.02;
constexpr int deepest = 24;  // halvings

}  // namespace

LuminaireSource::LuminaireSource(const Luminaire& luminaire) : luminaire_(luminaire) {
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
    for (const Facet& f : facets_) shown += f.area * std::max(0.0, dot(f.normal, direction));
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
    if (longest > near_share * distance && depth < deepest) {
        if (along >= across)
            return integrate(facet, point, normal, s0, s, t0, t1, depth + 1) +
                   integrate(facet, point, normal, s, s1, t0, t1, depth + 1);
        return integrate(facet, point, normal, s0, s1, t0, t, depth + 1) +
               integrate(facet, point, normal, s0, s1, t, t1, depth + 1);
    }
    const double cell = (s1 - s0) * (t1 - t0);
    if (longest < far_share * distance)
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

template <class Weight>
std::size_t LuminaireSource::choose(const Weight& weight, double& u, double& chance) const {
    double total = 0;
    for (const Facet& facet : facets_) total += weight(facet);
    if (!(total > 0)) return facets_.size();
    double below = 0, last_weight = 0;
    std::size_t chosen = facets_.size();
    for (std::size_t f = 0; f < facets_.size(); ++f) {
        const double own = weight(facets_[f]);
        if (own <= 0) continue;
        chosen = f;
        last_weight = own;
        if (u * total < below + own) break;
        below += own;
    }
    u = std::clamp((u * total - below) / last_weight, 0.0, 1 - 1e-12);
    chance = last_weight / total;
    return chosen;
}

LuminaireSource::Sample LuminaireSource::sample(const Vec3& point, const Vec3& normal, double u,
                                                double v) const {
    Sample out;
    if (facets_.empty()) {
        const bool below = dot(point - luminaire_.position, luminaire_.nadir) > 0;
        return {luminaire_.position, below ? luminaire_.nadir : -luminaire_.nadir, 1};
    }
    double chance = 1;
    const std::size_t chosen = choose(
        [&](const Facet& facet) {
            if (facet.is_line) return 1.0;
            const Vec3 way = point - facet.middle;
            const double facing = dot(facet.normal, way);
            return facing > 0 ? facet.area * facing / std::pow(dot(way, way), 1.5) : 0.0;
        },
        u, chance);
    if (chosen == facets_.size()) return out;
    const Facet& facet = facets_[chosen];
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
    double chance = 1;
    const std::size_t chosen = choose(
        [&](const Facet& facet) {
            return facet.is_line ? 1.0 : facet.area * std::max(0.0, dot(facet.normal, direction));
        },
        u, chance);
    if (chosen == facets_.size()) return {luminaire_.position, direction, 0};
    const Facet& facet = facets_[chosen];
    return {facet.at(u, v), facet.is_line ? direction : facet.normal,
            facet.jacobian(u, v) / facet.area};
}

}  // namespace exitance
