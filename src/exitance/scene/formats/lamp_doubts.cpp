// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/lamp_doubts.h"

#include <fmt/format.h>

#include <cmath>

#include "exitance/scene/lamp_figures.h"

namespace exitance {

std::vector<Problem> doubts(const Photometry& photometry, const Place& place) {
    constexpr double most_output = 1.01;  // more than all of it, but for the rounding of tables
    constexpr double agreement = 0.02;    // of the ratio that is stated
    std::vector<Problem> out;
    const auto tell = [&](std::string what) { out.push_back({place, std::move(what)}); };
    const double flux = photometry.flux();
    if (!(flux > 0)) tell("the luminaire is dark: it has no flux");
    if (!photometry.absolute && photometry.lamp_lumens && *photometry.lamp_lumens > 0 && flux > 0) {
        const double ratio = flux / *photometry.lamp_lumens;
        if (ratio > most_output)
            tell(fmt::format("{:.4g} lm leave the luminaire, more than the {:.4g} lm of its lamps",
                             flux, *photometry.lamp_lumens));
        else if (photometry.stated_lor && std::abs(ratio / *photometry.stated_lor - 1) > agreement)
            tell(fmt::format("the light output ratio is {:.1f} %, but the file states {:.1f} %",
                             100 * ratio, 100 * *photometry.stated_lor));
    }
    const auto near = [](double x, double y) { return std::abs(x - y) < 0.01; };
    const double from = photometry.gammas.front(), to = photometry.gammas.back();
    const bool begins = near(from, 0) || (near(from, 90) && near(to, 180));
    if (!begins || !(near(to, 90) || near(to, 180)))
        tell(
            fmt::format("the angles γ go from {:g} to {:g}°, expected from 0 or 90 to 90 or 180; "
                        "beyond them the luminaire is dark",
                        from, to));
    return out;
}

}  // namespace exitance
