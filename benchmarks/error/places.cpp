// SPDX-License-Identifier: Apache-2.0
#include "error/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/math/warp.h"
#include "exitance/run/error.h"
#include "exitance/run/random.h"
#include "exitance/visibility/exposure.h"

namespace exitance::benchmarks {

namespace {

constexpr std::size_t side = 64;
constexpr std::size_t contact_texels = 2;
// Of a texel: where it is asked whether something covers it.
constexpr std::array<double, 3> across{-0.49, 0.0, 0.49};
constexpr std::uint64_t seed = 0x91ace5;

class Exposure {
  public:
    explicit Exposure(const Scene& scene) : caster_(make_caster(scene)) {
        for (const Polygon& polygon : scene.polygons)
            two_sided_.push_back(scene.material(polygon).two_sided);
    }
    std::vector<char> of(std::span<const truth::Receiver> places) const {
        Receivers receivers;
        for (const truth::Receiver& place : places)
            receivers.add(place.position - caster_.middle(), place.normal,
                          static_cast<std::uint32_t>(receivers.size()));
        std::vector<char> exposed(places.size());
        find_exposed(caster_, two_sided_, receivers, 0, exposed);
        return exposed;
    }

  private:
    static RayCaster make_caster(const Scene& scene) {
        std::vector<RayCaster::Face> faces;
        for (const Polygon& polygon : scene.polygons) {
            const auto& c = polygon.corners;
            faces.push_back({c[0], c[1], c[2], polygon.size() == 4 ? c[3] : c[2]});
        }
        return RayCaster(scene.points, faces, {});
    }
    RayCaster caster_;
    std::vector<char> two_sided_;
};

bool reflects(const Scene& scene, const Polygon& polygon) {
    const Material& material = scene.material(polygon);
    return luminance(material.reflectance) > 0;
}

/// The place (u, v) of the unit square, which a triangle folds, and its shading normal.
truth::Receiver at(const Scene& scene, const Polygon& polygon, double u, double v) {
    std::array<double, 4> weight{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    if (polygon.size() == 3) {
        const auto w = uniform_triangle({u, v});
        weight = {w[0], w[1], w[2], 0};
    }
    const Vec3 flat = scene.normal(polygon);
    Vec3 position, normal;
    for (std::uint32_t c = 0; c < polygon.size(); ++c) {
        const std::uint32_t corner = polygon.corners[c];
        position += scene.points[corner] * weight[c];
        const bool smooth = corner < scene.normals.size() && dot(scene.normals[corner], flat) > 0;
        normal += (smooth ? scene.normals[corner] : flat) * weight[c];
    }
    return {position, normalized(normal)};
}

std::vector<Place> points(const Scene& scene, std::size_t count) {
    std::vector<double> cumulative;
    double total = 0;
    for (const Polygon& polygon : scene.polygons)
        cumulative.push_back(total += reflects(scene, polygon) ? scene.area(polygon) : 0.0);
    std::vector<truth::Receiver> receivers;
    for (std::size_t i = 0; i < count; ++i) {
        const double where =
            (static_cast<double>(i) + uniform(seed, 3 * i)) / static_cast<double>(count) * total;
        const auto p = static_cast<std::size_t>(
            std::upper_bound(cumulative.begin(), cumulative.end(), where) - cumulative.begin());
        const Polygon& polygon = scene.polygons[std::min(p, scene.polygons.size() - 1)];
        receivers.push_back(at(scene, polygon, uniform(seed, 3 * i + 1), uniform(seed, 3 * i + 2)));
    }
    const std::vector<char> exposed = Exposure(scene).of(receivers);
    std::vector<Place> out;
    for (std::size_t i = 0; i < count; ++i)
        if (exposed[i]) out.push_back({receivers[i]});
    return out;
}

std::vector<Place> texels(const Scene& scene) {
    const Exposure exposure(scene);
    std::vector<Place> out;
    for (const Polygon& polygon : scene.polygons) {
        if (!reflects(scene, polygon) || polygon.size() != 4) continue;
        std::vector<truth::Receiver> asked;
        for (std::size_t t = 0; t < side * side; ++t)
            for (const double dv : across)
                for (const double du : across) {
                    const double u = (static_cast<double>(t % side) + 0.5 + du) / double(side);
                    const double v = (static_cast<double>(t / side) + 0.5 + dv) / double(side);
                    asked.push_back(at(scene, polygon, u, v));
                }
        const std::vector<char> exposed = exposure.of(asked);
        constexpr std::size_t each = across.size() * across.size();
        std::vector<std::size_t> open(side * side);
        for (std::size_t i = 0; i < asked.size(); ++i) open[i / each] += exposed[i] ? 1 : 0;
        for (std::size_t t = 0; t < side * side; ++t) {
            if (open[t] < each) continue;
            bool contact = false;
            const std::size_t u = t % side, v = t / side;
            for (std::size_t y = v - std::min(v, contact_texels);
                 y <= std::min(v + contact_texels, side - 1); ++y)
                for (std::size_t x = u - std::min(u, contact_texels);
                     x <= std::min(u + contact_texels, side - 1); ++x)
                    contact = contact || open[y * side + x] < each;
            out.push_back({asked[t * each + each / 2], contact});
        }
    }
    return out;
}

}  // namespace

std::vector<Place> find_places(const Scene& scene, const std::string& which) {
    if (which == "texels") return texels(scene);
    std::size_t count = 0;
    for (const char c : which) {
        if (c < '0' || c > '9' || count > 1000000)
            throw Error(
                Fault::wrong_use,
                "places: found '" + which + "', expected a number up to " + "1000000 or 'texels'");
        count = 10 * count + static_cast<std::size_t>(c - '0');
    }
    return points(scene, count);
}

}  // namespace exitance::benchmarks
