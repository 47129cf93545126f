// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/rad_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;

enum class Kind {
    plastic,     // r g b specularity roughness
    metal,       // the same; what is mirrored has the colour
    trans,       // r g b specularity roughness transmission share-straight-through
    light,       // r g b
    glow,        // r g b radius
    spotlight,   // r g b angle direction
    mirror,      // r g b
    glass,       // r g b [index]
    dielectric,  // r g b index hartmann
    brtd,        // front r g b, back r g b, transmitted r g b
    clear        // lets everything through
};

struct Form {
    Kind kind;
    std::size_t least;  // real arguments
    bool exact;         // it is what the type means
    bool two_roughnesses = false;
};

const std::map<std::string_view, Form>& forms() {
    static const std::map<std::string_view, Form> table{
        {"plastic", {Kind::plastic, 5, true}},
        {"metal", {Kind::metal, 5, true}},
        {"trans", {Kind::trans, 7, true}},
        {"plastic2", {Kind::plastic, 6, true, true}},
        {"metal2", {Kind::metal, 6, true, true}},
        {"trans2", {Kind::trans, 8, true, true}},
        {"ashik2", {Kind::plastic, 5, false}},
        {"plasfunc", {Kind::plastic, 4, false}},
        {"plasdata", {Kind::plastic, 4, false}},
        {"metfunc", {Kind::metal, 4, false}},
        {"metdata", {Kind::metal, 4, false}},
        {"transfunc", {Kind::trans, 6, false}},
        {"transdata", {Kind::trans, 6, false}},
        {"BRTDfunc", {Kind::brtd, 9, false}},
        {"BSDF", {Kind::brtd, 0, false}},
        {"aBSDF", {Kind::brtd, 0, false}},
        {"light", {Kind::light, 3, true}},
        {"illum", {Kind::light, 3, true}},
        {"glow", {Kind::glow, 4, true}},
        {"spotlight", {Kind::spotlight, 7, false}},
        {"mirror", {Kind::mirror, 3, true}},
        {"glass", {Kind::glass, 3, true}},
        {"dielectric", {Kind::dielectric, 5, true}},
        {"interface", {Kind::dielectric, 8, false}},
        {"prism1", {Kind::clear, 0, false}},
        {"prism2", {Kind::clear, 0, false}},
        {"mist", {Kind::clear, 0, false}},
        {"antimatter", {Kind::clear, 0, false}},
    };
    return table;
}

Spectrum times(const Spectrum& colour, double factor) {
    Spectrum out = colour;
    for (double& band : out) band *= factor;
    return out;
}

Spectrum grey(double value) {
    return {value, value, value};
}

// Share that a surface between air and a body of this refractive index mirrors at normal incidence
// (Fresnel).
double mirrored(double index) {
    const double r = (index - 1) / (index + 1);
    return r * r;
}

class RadMaterial {
  public:
    RadMaterial(std::span<const double> reals, const Place& place, Material& out)
        : reals_(reals), place_(place), out_(out) {}

    void read(Kind kind, bool two_roughnesses) {
        switch (kind) {
            case Kind::plastic:
            case Kind::metal:
            case Kind::trans:
                return body(kind, two_roughnesses);
            case Kind::light:
            case Kind::glow:
                return emit(pi);
            case Kind::spotlight: {
                // Within a cone of this full angle, π sin² of half of it times the radiance.
                const double sine = std::sin(share(3, 180, "an angle, 0 to 180") * pi / 360);
                return emit(pi * sine * sine);
            }
            case Kind::mirror:
                out_.specular = colour(0, 1);
                return;
            case Kind::glass:
                return glass();
            case Kind::dielectric: {
                const double index = share(3, 10, "a refractive index, 0.1 to 10", 0.1);
                out_.refractive_index = index;
                out_.specular = grey(mirrored(index));
                out_.transmittance = grey(1 - mirrored(index));
                return;
            }
            case Kind::brtd:
                if (reals_.size() >= 3) out_.reflectance = colour(0, 1);
                if (reals_.size() >= 9) out_.diffuse_transmittance = colour(6, 1);
                return limit();
            case Kind::clear:
                out_.transmittance = grey(1);
                return;
        }
    }

  private:
    double share(std::size_t i, double most, const char* expected, double least = 0) const {
        if (!(reals_[i] >= least && reals_[i] <= most))
            throw Error(place_, fmt::format("found {:g} as real argument {}, expected {}",
                                            reals_[i], i + 1, expected));
        return reals_[i];
    }
    Spectrum colour(std::size_t first, double most) const {
        Spectrum out;
        for (std::size_t i = first; i < first + 3; ++i)
            out.push_back(
                share(i, most, most == 1 ? "a share of light, 0 to 1" : "a radiance, 0 or more"));
        return out;
    }

    void body(Kind kind, bool two_roughnesses) {
        const Spectrum c = colour(0, 1);
        const double specularity = share(3, 1, "a specularity, 0 to 1");
        if (reals_.size() > 4 && out_.roughness == 0)
            out_.roughness = share(4, 1e6, "a roughness, 0 or more");
        if (two_roughnesses)
            out_.roughness = std::sqrt(out_.roughness * share(5, 1e6, "a roughness, 0 or more"));
        double through = 0, straight = 0;
        if (kind == Kind::trans) {
            const std::size_t at = reals_.size() - 2;
            through = share(at, 1, "a transmission, 0 to 1");
            straight = share(at + 1, 1, "a share of the transmission, 0 to 1");
        }
        // Ward, "The RADIANCE lighting simulation": what is not mirrored is reflected or
        // transmitted by the body and takes its colour.
        out_.specular = kind == Kind::metal ? times(c, specularity) : grey(specularity);
        const Spectrum rest = times(c, 1 - specularity);
        out_.reflectance = times(rest, 1 - through);
        if (through > 0) {
            out_.diffuse_transmittance = times(rest, through * (1 - straight));
            out_.transmittance = times(rest, through * straight);
        }
    }

    void emit(double factor) {
        out_.exitance = times(colour(0, limits::exitance / 10), factor);
        out_.two_sided = false;
    }

    // The pane reflects at both faces, again and again; t is the share that survives one way
    // through the glass.
    void glass() {
        const double index =
            reals_.size() > 3 ? share(3, 10, "a refractive index, 0.1 to 10", 0.1) : 1.52;
        const double r = mirrored(index);
        for (const double t : colour(0, 1)) {
            const double once = 1 - r * r * t * t;
            out_.transmittance.push_back((1 - r) * (1 - r) * t / once);
            out_.specular.push_back(r + (1 - r) * (1 - r) * r * t * t / once);
        }
        out_.refractive_index = index;
    }

    void limit() {
        if (out_.diffuse_transmittance.empty()) return;
        for (std::size_t b = 0; b < 3; ++b) {
            const double sum = out_.reflectance[b] + out_.diffuse_transmittance[b];
            if (sum <= 1) continue;
            out_.reflectance[b] /= sum;
            out_.diffuse_transmittance[b] /= sum;
        }
    }

    std::span<const double> reals_;
    const Place& place_;
    Material& out_;
};

}  // namespace

bool is_rad_material(std::string_view type) {
    return forms().contains(type);
}

bool is_rad_pattern(std::string_view type) {
    static constexpr std::array<std::string_view, 18> types{
        "texfunc",   "texdata",    "colorfunc", "brightfunc", "colordata", "brightdata",
        "colorpict", "brightpict", "colortext", "brighttext", "mixfunc",   "mixdata",
        "mixpict",   "mixtext",    "spectrum",  "specfile",   "specfunc",  "specdata"};
    return std::find(types.begin(), types.end(), type) != types.end();
}

Material rad_material(const std::string& name, std::string_view type, std::span<const double> reals,
                      const Place& place, ReadWarnings& warnings) {
    const Form& form = forms().at(type);
    if (reals.size() < form.least)
        throw Error(place, fmt::format("found {} real arguments of {}, expected {} or more",
                                       reals.size(), in_quotes(type), form.least));
    Material out;
    out.name = as_utf8(name);
    out.place = place;
    out.reflectance = grey(0);
    out.exitance = grey(0);
    out.two_sided = true;
    RadMaterial(reals, place, out).read(form.kind, form.two_roughnesses);
    if (!form.exact) {
        const char* as = form.kind == Kind::clear       ? "clear"
                         : form.kind == Kind::spotlight ? "a lamp that sends the same flux all over"
                                                        : "its diffuse part";
        warnings.add("material type " + std::string(type), place,
                     fmt::format("material {} is of type {}, which is taken as {}", in_quotes(name),
                                 type, as));
    }
    const auto positive = [](const Spectrum& s) {
        return std::any_of(s.begin(), s.end(), [](double v) { return v > 0; });
    };
    if (positive(out.specular))
        warnings.note("specular", place,
                      fmt::format("mirror-like reflection (of material {}) is not part of the "
                                  "radiosity solution; it is left to the second pass",
                                  in_quotes(name)));
    if (positive(out.diffuse_transmittance))
        warnings.add("translucent", place,
                     fmt::format("diffuse transmission (of material {}) is kept but not solved "
                                 "for; that light counts as absorbed",
                                 in_quotes(name)));
    return out;
}

}  // namespace exitance
