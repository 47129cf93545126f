// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "exitance/scene/builtin_photometry.h"
#include "exitance/scene/formats/ies.h"
#include "exitance/scene/formats/limits.h"

namespace exitance {

namespace {

JsonNode extension(const JsonNode& object, const std::string& name) {
    const JsonNode extensions = object.member("extensions");
    return extensions ? extensions.member(name) : extensions;
}

double number(const JsonNode& object, const std::string& key, double otherwise) {
    const JsonNode value = object.member(key);
    return value ? value.value->get<double>() : otherwise;
}

/// 1 cd on the axis; from the inner to the outer cone it falls as the square of a ramp in the
/// cosine (KHR_lights_punctual, "Inner and Outer Cone Angles").
Photometry cone_photometry(double inner, double outer) {
    constexpr int steps = 32;  // the bilinear table then errs by less than 0.1 % of the axis
    constexpr double degree = std::numbers::pi / 180;
    Photometry out = isotropic_photometry();
    out.planes = {0};
    out.gammas = {0};
    out.candela = {1};
    const double least = 0.001;  // of the ramp, as the extension says
    const double ramp = std::max(least, std::cos(inner) - std::cos(outer));
    for (int i = 0; i <= steps; ++i) {
        const double gamma = inner + (outer - inner) * i / steps;
        const double share = std::clamp((std::cos(gamma) - std::cos(outer)) / ramp, 0.0, 1.0);
        if (gamma / degree <= out.gammas.back()) continue;
        out.gammas.push_back(gamma / degree);
        out.candela.push_back(share * share);
    }
    return out;
}

[[noreturn]] void refuse_direction(const Place& place, const std::string& name) {
    throw Error(place, fmt::format("the node of the light '{}' has no direction, expected a scale "
                                   "that is not zero",
                                   name));
}

/// A colour as its proportions, of luminance 1, and its luminance.
struct Tint {
    Spectrum colour{1, 1, 1};
    double luminance = 1;
};
Tint tint_of(const JsonNode& colour) {
    Tint out;
    if (!colour) return out;
    out.colour = colour.value->get<std::vector<double>>();
    out.luminance = luminance(out.colour);
    if (out.luminance > 0)
        for (double& band : out.colour) band /= out.luminance;
    return out;
}

}  // namespace

GltfLights::GltfLights(Scene& scene, const GltfResources& resources, const JsonText& json)
    : scene_(scene),
      resources_(resources),
      json_(json),
      point_(std::make_shared<const Photometry>(isotropic_photometry())) {}

void GltfLights::add(std::size_t index, const std::string& name, const Transform& world) {
    const JsonNode root{&json_, &json_.root(), ""};
    const JsonNode node = root.required("nodes").element(index);
    if (const JsonNode placed = extension(node, "KHR_lights_punctual")) {
        const JsonNode lights = extension(root, "KHR_lights_punctual").required("lights");
        add_punctual(lights.element(placed.required("light").value->get<std::size_t>()), name,
                     world);
    }
    if (const JsonNode placed = extension(node, "EXT_lights_ies")) add_ies(placed, name, world);
}

void GltfLights::add_punctual(const JsonNode& light, const std::string& name,
                              const Transform& world) {
    const std::string& type = light.required("type").string();
    if (type == "directional") return add_directional(light, name, world);
    if (type != "point" && type != "spot")
        light.required("type").expected("point, spot or directional");
    Luminaire luminaire;
    luminaire.name = name;
    luminaire.place = json_.place(light.path);
    luminaire.photometry = point_;
    if (type == "spot") {
        const JsonNode spot = light.member("spot");
        const double quarter = std::numbers::pi / 4;
        const double inner = spot ? number(spot, "innerConeAngle", 0) : 0;
        const double outer = spot ? number(spot, "outerConeAngle", quarter) : quarter;
        if (!(inner < outer))
            json_.refuse(light.path,
                         fmt::format("found an inner cone of {:g} and an outer one of {:g}, "
                                     "expected the outer to be wider",
                                     inner, outer));
        luminaire.photometry = std::make_shared<const Photometry>(cone_photometry(inner, outer));
    }
    place(std::move(luminaire), light.member("color"), number(light, "intensity", 1), world);
}

// Shines along the node's −z, from infinity; its intensity is in lux across its rays.
void GltfLights::add_directional(const JsonNode& light, const std::string& name,
                                 const Transform& world) {
    DistantLight out;
    out.name = name;
    out.place = json_.place(light.path);
    out.direction = normalized(world.z);
    if (!is_finite(out.direction) || out.direction == Vec3{}) refuse_direction(out.place, name);
    const Tint tint = tint_of(light.member("color"));
    out.irradiance = number(light, "intensity", 1) * tint.luminance;
    if (!(out.irradiance > 0)) return;
    out.colour = tint.colour;
    if (!(out.irradiance <= limits::exitance))
        throw Error(
            out.place,
            fmt::format("found the irradiance {:g} in the light '{}', expected at most {:g}",
                        out.irradiance, name, limits::exitance));
    scene_.distant.push_back(std::move(out));
}

void GltfLights::add_ies(const JsonNode& placed, const std::string& name, const Transform& world) {
    const JsonNode root{&json_, &json_.root(), ""};
    const std::size_t which = placed.required("light").value->get<std::size_t>();
    auto& photometry = photometry_[which];
    if (!photometry) {
        const JsonNode light = extension(root, "EXT_lights_ies").required("lights").element(which);
        const std::string file =
            resources_.name(light, json_.place(light.path).file + ": " + light.path);
        LampFile lamp =
            parse_ies(file, resources_.bytes(light), [&](const std::string&) -> TiltFile {
                json_.refuse(light.path,
                             "its TILT names another file, expected TILT=NONE or INCLUDE");
            });
        for (Problem& warning : lamp.warnings) scene_.warnings.push_back(std::move(warning));
        photometry = std::make_shared<const Photometry>(std::move(lamp.photometry));
    }
    Luminaire luminaire;
    luminaire.name = name;
    luminaire.place = json_.place(placed.path);
    luminaire.photometry = photometry;
    place(std::move(luminaire), placed.member("color"), number(placed, "multiplier", 1), world);
}

// Shines along the node's −z, C0 along its x. A colour multiplies the intensity band by band.
void GltfLights::place(Luminaire luminaire, const JsonNode& colour, double level,
                       const Transform& world) {
    luminaire.position = world.origin;
    const Vec3 nadir = normalized(-world.z);
    const Vec3 c0 = normalized(world.x - nadir * dot(world.x, nadir));
    if (!is_finite(world.origin) || !is_finite(nadir) || !is_finite(c0) ||
        std::abs(length(nadir) - 1) > 1e-6 || std::abs(length(c0) - 1) > 1e-6)
        refuse_direction(luminaire.place, luminaire.name);
    luminaire.nadir = nadir;
    luminaire.c0 = c0;
    if (world.determinant() < 0)
        luminaire.photometry = std::make_shared<const Photometry>(mirrored(*luminaire.photometry));
    const Tint tint = tint_of(colour);
    if (!(tint.luminance * level > 0)) return;
    luminaire.colour = tint.colour;
    luminaire.multiplier = level * tint.luminance;
    const double flux = luminaire.flux();
    if (!(flux <= limits::exitance))
        throw Error(luminaire.place,
                    fmt::format("found the flux {:g} in the light '{}', expected at most {:g}",
                                flux, luminaire.name, limits::exitance));
    scene_.luminaires.push_back(std::move(luminaire));
}

}  // namespace exitance
