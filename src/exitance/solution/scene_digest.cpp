// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>

#include "exitance/run/random.h"
#include "exitance/solution/extract.h"

namespace exitance {

std::string digest(const Scene& scene) {
    std::uint64_t h = 0;
    const auto add = [&](std::uint64_t bits) { h = hash_bits(h, bits); };
    const auto number = [&](double value) { add(std::bit_cast<std::uint64_t>(value)); };
    for (const Vec3& p : scene.points) number(p.x), number(p.y), number(p.z);
    for (const Polygon& polygon : scene.polygons) {
        for (const std::uint32_t corner : polygon.corners) add(corner);
        add(polygon.surface);
    }
    for (const Surface& surface : scene.surfaces) add(surface.material);
    for (const Material& material : scene.materials) {
        for (const double r : material.reflectance) number(r);
        for (const double e : material.exitance) number(e);
        add(material.two_sided);
        for (const Pattern* pattern : {&material.reflectance_pattern, &material.exitance_pattern}) {
            if (!*pattern) continue;
            add(pattern->texture->digest());
            for (const double f : pattern->factor) number(f);
        }
    }
    for (const TextureCoordinates& t : scene.texture_coordinates)
        for (const TexturePoint& p : {t.reflectance, t.exitance})
            number(double(p.u)), number(double(p.v));
    for (const Luminaire& luminaire : scene.luminaires) {
        for (const Vec3& v : {luminaire.position, luminaire.c0, luminaire.nadir})
            number(v.x), number(v.y), number(v.z);
        number(luminaire.multiplier);
        for (const double c : luminaire.colour) number(c);
        for (const double angle : luminaire.photometry->planes) number(angle);
        for (const double angle : luminaire.photometry->gammas) number(angle);
        for (const double candela : luminaire.photometry->candela) number(candela);
        const LuminousOpening& opening = luminaire.photometry->opening;
        add(static_cast<std::uint64_t>(opening.shape));
        number(opening.size.x), number(opening.size.y), number(opening.size.z);
    }
    for (const DistantLight& light : scene.distant) {
        add(static_cast<std::uint64_t>(light.kind));
        for (const double c : light.colour) number(c);
        const SkyModel& m = light.model;
        for (const Vec3& v : {light.direction, m.sun}) number(v.x), number(v.y), number(v.z);
        for (const double x : {light.diameter, light.irradiance, light.ground, light.strength, m.a,
                               m.b, m.c, m.d, m.e, m.circumsolar_offset, m.scale})
            number(x);
        add(m.traditional_overcast);
        if (!light.map) continue;
        for (const float cell : light.map->cells) number(double(cell));
    }
    for (const Material& material : scene.materials)
        if (material.clear_transmittance() > 0) number(material.clear_transmittance());
    return fmt::format("{:016x}", h);
}

}  // namespace exitance
