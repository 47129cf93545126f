// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
// Chromaticities are written in three or four digits; bands that move by less are rounding.
constexpr double noticeable = 5e-3;

double largest_difference(const Spectrum& a, const Spectrum& b) {
    double out = 0;
    for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
    return out;
}

// The share in RGB with no band below zero; `outside` is set where that moved the colour.
Spectrum rgb_of_share(const MgfShare& share, bool& outside) {
    if (!(share.value > 0)) return {};
    const Spectrum rgb = rgb_of(share.colour);
    Spectrum out = toward_grey(rgb, gamut_share(rgb, unlimited));
    outside |= largest_difference(rgb, out) > noticeable;
    for (double& band : out) band *= share.value;
    return out;
}

// Paler, all alike, until no band of the sum is above 1; their luminances add up to 1 at most.
bool limit_sum(std::array<Spectrum*, 4> parts) {
    Spectrum sum(3);
    for (const Spectrum* part : parts)
        for (std::size_t b = 0; b < part->size(); ++b) sum[b] += (*part)[b];
    const double share = gamut_share(sum, 1);
    if (share >= 1) return false;
    for (Spectrum* part : parts)
        if (!part->empty()) *part = toward_grey(*part, share);
    return largest_difference(sum, toward_grey(sum, share)) > noticeable;
}

}  // namespace

Material scene_material(const std::string& name, const MgfMaterial& material,
                        ReadWarnings& warnings) {
    const std::string label = in_quotes(name.empty() ? "unnamed" : name);
    MgfMaterial m = material;
    const double sum = m.rd.value + m.td.value + m.rs.value + m.ts.value;
    if (sum > 1) {
        // Four digits of three or four shares may round to a little more than 1.
        if (sum > 1.0005)
            warnings.add("energy of " + name, m.place,
                         fmt::format("rd + td + rs + ts of material {} is {:.4g}; scaled down to 1",
                                     label, sum));
        for (MgfShare* share : {&m.rd, &m.td, &m.rs, &m.ts}) share->value /= sum;
    }
    Material out;
    out.name = name.empty() ? "unnamed" : as_utf8(name);
    out.place = m.place;
    out.two_sided = m.two_sided;
    bool outside = false;
    out.reflectance = rgb_of_share(m.rd, outside);
    out.diffuse_transmittance = rgb_of_share(m.td, outside);
    out.specular = rgb_of_share(m.rs, outside);
    out.transmittance = rgb_of_share(m.ts, outside);
    outside |= limit_sum(
        {&out.reflectance, &out.diffuse_transmittance, &out.specular, &out.transmittance});
    out.exitance = rgb_of_share(m.ed, outside);
    if (outside)
        warnings.add("gamut of " + name, m.place,
                     fmt::format("a colour of material {} is outside what RGB can show; taken "
                                 "paler, as bright",
                                 label));
    for (Spectrum* needed : {&out.reflectance, &out.exitance})
        if (needed->empty()) needed->assign(3, 0.0);
    for (double& band : out.reflectance) band = std::min(band, 1.0);
    out.roughness = m.rs.value > 0 ? m.rs_roughness : m.ts_roughness;
    if (m.refractive_index != 1) out.refractive_index = m.refractive_index;
    if (m.rs.value > 0)
        warnings.note("specular", m.place,
                      fmt::format("mirror-like reflection (rs of material {}) is not part of the "
                                  "radiosity solution; it is left to the second pass",
                                  label));
    if (m.td.value > 0)
        warnings.add("translucent", m.place,
                     fmt::format("diffuse transmission (td of material {}) is kept but not solved "
                                 "for; that light counts as absorbed",
                                 label));
    if (m.ts.value > 0 && m.ts_roughness > 0)
        warnings.add("frosted", m.place,
                     fmt::format("rough transmission (ts of material {}) goes straight through, as "
                                 "if clear",
                                 label));
    return out;
}

}  // namespace exitance
