// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf_contexts.h"

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/mgf_reader.h"

namespace exitance {

void MgfReader::chromaticity(Words words) {
    const char* expected = "a chromaticity: x at least 0, y above 0, x + y at most 1";
    const double x = number(words, 0, expected, 0, 1), y = number(words, 1, expected, 1e-6, 1);
    if (x + y > 1 + 1e-6) refuse(1, expected);
    colours_.current().xyz = xyz_of_chromaticity(x, y);
}

void MgfReader::spectrum(Words words) {
    SampledSpectrum spectrum;
    spectrum.first = number(words, 0, "a wavelength in nm", 1, 1e5);
    spectrum.last = number(words, 1, "a longer wavelength in nm", spectrum.first + 1e-3, 1e5);
    for (std::size_t i = 2; i < words.size(); ++i)
        spectrum.values.push_back(number(words, i, "a value of the spectrum, 0 or more", 0, 1e30));
    set_spectrum(spectrum);
}

void MgfReader::temperature(Words words) {
    set_spectrum(black_body(number(words, 0, "a temperature of 100 to 1e6 K", 100, 1e6)));
}

void MgfReader::set_spectrum(const SampledSpectrum& spectrum) {
    colours_.current().xyz = xyz_of_spectrum(spectrum);
    if (colours_.current().xyz.y > 0) return;
    warn("invisible", "a spectrum without visible light is taken as white");
    colours_.current() = MgfColour{};
}

void MgfReader::mix(Words words) {
    Xyz sum{0, 0, 0};
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
        const double weight = number(words, i, "a weight, 0 or more", 0, 1e30);
        const MgfColour* part = colours_.find(words[i + 1]);
        if (part == nullptr)
            throw Error(lines_->place(i + 2),
                        fmt::format("there is no colour {}{}", in_quotes(words[i + 1]),
                                    suggestion(std::string(words[i + 1]), colours_.names())));
        sum.x += weight * part->xyz.x;
        sum.y += weight * part->xyz.y;
        sum.z += weight * part->xyz.z;
    }
    if (words.size() % 2 != 0) refuse(words.size(), "a weight and a colour in turn");
    if (!(sum.y > 0)) refuse(0, "weights that are not all zero");
    colours_.current().xyz = {sum.x / sum.y, 1, sum.z / sum.y};
}

void MgfReader::material(Words words) {
    enter(materials_, words, "material");
    if (words.size() == 1) return;
    materials_.current().place = lines_->line_place();
    touch();
}

void MgfReader::set_share(MgfShare MgfMaterial::*share, double value) {
    materials_.current().*share = {value, colours_.current().xyz};
    touch();
}

void MgfReader::diffuse_reflection(Words words) {
    set_share(&MgfMaterial::rd, number(words, 0, share_expected, 0, 1));
}

void MgfReader::diffuse_transmission(Words words) {
    set_share(&MgfMaterial::td, number(words, 0, share_expected, 0, 1));
}

void MgfReader::emission(Words words) {
    set_share(&MgfMaterial::ed,
              number(words, 0, "an exitance in lm/m², 0 or more", 0, limits::exitance));
}

void MgfReader::specular_reflection(Words words) {
    set_share(&MgfMaterial::rs, number(words, 0, share_expected, 0, 1));
    materials_.current().rs_roughness = number(words, 1, "a roughness, 0 or more", 0, 1e6);
}

void MgfReader::specular_transmission(Words words) {
    set_share(&MgfMaterial::ts, number(words, 0, share_expected, 0, 1));
    materials_.current().ts_roughness = number(words, 1, "a roughness, 0 or more", 0, 1e6);
}

void MgfReader::refraction(Words words) {
    materials_.current().refractive_index =
        number(words, 0, "a refractive index above 0", 1e-3, 1e3);
    number(words, 1, "the imaginary part of a refractive index, 0 or more", 0, 1e6);
    touch();
}

void MgfReader::sides(Words words) {
    if (words[0] != "1" && words[0] != "2") refuse(0, "1 or 2 sides");
    materials_.current().two_sided = words[0] == "2";
    touch();
}

Vec3 MgfReader::vector(Words words, const char* expected) const {
    Vec3 v;
    for (std::size_t i = 0; i < 3; ++i)
        v[i] = number(words, i, expected, -limits::coordinate, limits::coordinate);
    return v;
}

void MgfReader::point(Words words) {
    vertices_.current().point = vector(words, "a coordinate, at most 1e9");
}

void MgfReader::normal(Words words) {
    vertices_.current().normal = normalized(vector(words, "part of a direction, at most 1e9"));
}

}  // namespace exitance
