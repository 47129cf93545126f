// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/imported_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "exitance/scene/builtin_photometry.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

using Kind = ImportedLight::Kind;

void aim(Luminaire& luminaire, const Vec3& nadir) {
    const Vec3 aside = std::abs(nadir.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    luminaire.nadir = nadir;
    luminaire.c0 = normalized(aside - nadir * dot(aside, nadir));
}

}  // namespace

void add_imported_light(Scene& scene, const ImportedLight& light, const Transform& placing,
                        const Place& place, ReadWarnings& warnings) {
    const std::string quoted = in_quotes(light.name);
    if (light.kind == Kind::other) {
        warnings.add("light", place,
                     fmt::format("light {} is neither a point, a spot nor directional and is left "
                                 "out",
                                 quoted));
        return;
    }
    const Vec3 position = placing.point(light.position);
    const Vec3 direction = normalized(placing.vector(light.direction));
    const bool aimed = is_finite(direction) && direction != Vec3{};
    Spectrum colour(light.colour.begin(), light.colour.end());
    const double strength = luminance(colour);
    const bool sound = std::all_of(colour.begin(), colour.end(),
                                   [](double c) { return c >= 0 && c <= limits::exitance; });
    if (!sound || !(strength > 0) || !is_finite(position) ||
        (light.kind == Kind::directional && !aimed)) {
        warnings.add("dark light", place,
                     fmt::format("light {} does not shine and is left out", quoted));
        return;
    }
    for (double& band : colour) band /= strength;
    const std::size_t number = scene.luminaires.size() + scene.distant.size() + 1;
    const std::string name =
        light.name.empty() ? fmt::format("light {}", number) : as_utf8(light.name);
    warnings.add(
        "light unit", place,
        fmt::format("the strength of light {} has no unit in the file; it is taken as its "
                    "{}",
                    in_quotes(name), light.kind == Kind::directional ? "irradiance" : "intensity"));
    if (light.kind == Kind::directional) {
        DistantLight to;
        to.name = name;
        to.place = place;
        to.direction = -direction;
        to.irradiance = strength;
        to.colour = colour;
        scene.distant.push_back(std::move(to));
        return;
    }
    Luminaire to;
    to.name = name;
    to.place = place;
    to.position = position;
    to.multiplier = strength;
    to.colour = colour;
    constexpr double degree = std::numbers::pi / 180;
    const double field = light.outer_cone / degree;
    if (light.kind == Kind::point || !(field > 0 && field <= 180)) {
        to.photometry = std::make_shared<const Photometry>(isotropic_photometry());
    } else {
        if (aimed) aim(to, direction);
        const double beam = std::clamp(light.inner_cone / degree, 0.1 * field, 0.9 * field);
        to.photometry = std::make_shared<const Photometry>(spot_photometry(beam, field));
    }
    scene.luminaires.push_back(std::move(to));
}

}  // namespace exitance
