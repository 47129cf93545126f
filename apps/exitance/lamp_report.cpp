// SPDX-License-Identifier: Apache-2.0
#include "lamp_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "human_number.h"

namespace exitance::cli {

namespace {

using Json = nlohmann::ordered_json;

const char* symmetry_name(LampSymmetry symmetry) {
    switch (symmetry) {
        case LampSymmetry::none:
            return "none";
        case LampSymmetry::about_c0:
            return "about the plane C0–C180";
        case LampSymmetry::about_c90:
            return "about the plane C90–C270";
        case LampSymmetry::both:
            return "about the planes C0–C180 and C90–C270";
        case LampSymmetry::rotational:
            return "rotational";
    }
    return "";
}

std::string percent(double share) {
    return fmt::format("{:.1f} %", 100 * share);
}

std::string line(const std::string& label, const std::string& value) {
    return value.empty() ? "" : fmt::format("  {:<10}{}\n", label, value);
}

}  // namespace

std::string opening_text(const LuminousOpening& opening) {
    const Vec3& s = opening.size;
    const auto sizes = [&](const char* shape) {
        return fmt::format("{}, {} × {} × {} m along C0, C90, upwards", shape, human_number(s.x),
                           human_number(s.y), human_number(s.z));
    };
    switch (opening.shape) {
        case LuminousOpening::Shape::point:
            return "point";
        case LuminousOpening::Shape::box:
            return sizes(s.z > 0 ? "box" : "rectangle");
        case LuminousOpening::Shape::cylinder:
            if (s[opening.axis] == 0) return sizes("disc");
            return sizes(opening.axis == 2 ? "upright cylinder" : "lying cylinder");
        case LuminousOpening::Shape::ellipsoid:
            return sizes("ellipsoid");
    }
    return "";
}

LampReport::LampReport(LampFile lamp, std::filesystem::path file)
    : lamp_(std::move(lamp)), figures_(figures_of(lamp_.photometry)), file_(std::move(file)) {}

std::string LampReport::text() const {
    const Photometry& p = lamp_.photometry;
    const LampFigures& f = figures_;
    const std::size_t planes = p.planes.size() == 1 ? 1 : p.planes.size() - 1;
    std::string out = fmt::format("{}\n{}: {}, {} C-plane{} × {} angles γ from {} to {}°\n\n",
                                  p.name.empty() ? file_.stem().string() : p.name, file_.string(),
                                  lamp_.format, planes, planes == 1 ? "" : "s", p.gammas.size(),
                                  human_number(p.gammas.front()), human_number(p.gammas.back()));
    out += line("Maker", p.maker) + line("Catalogue", p.catalogue);
    std::string lamps = p.lamp;
    const auto say = [&](const std::string& what) { lamps += (lamps.empty() ? "" : ", ") + what; };
    if (p.lamp_lumens && !p.absolute) say(human_quantity(*p.lamp_lumens, "lm"));
    if (p.watts) say(human_quantity(*p.watts, "W"));
    if (lamp_.lamp_sets > 1) say(fmt::format("the first of {} sets", lamp_.lamp_sets));
    if (p.absolute) say("measured as a whole");
    out += line("Lamps", lamps);
    std::string flux = fmt::format("{}, {} below the horizontal", human_quantity(f.flux, "lm"),
                                   percent(f.downward));
    out += line("Flux", flux);
    if (f.output_ratio)
        out += line("LOR", percent(*f.output_ratio) +
                               (p.stated_lor ? " (stated: " + percent(*p.stated_lor) + ")" : ""));
    if (f.efficacy) out += line("Efficacy", human_quantity(*f.efficacy, "lm/W"));
    out += line("Peak", fmt::format("{} at C{}, γ {}°", human_quantity(f.peak, "cd"),
                                    human_number(f.peak_c), human_number(f.peak_gamma)));
    out += line("Beam",
                fmt::format("{:.1f}° × {:.1f}° (C0–C180 × C90–C270, 50 %)", f.beam[0], f.beam[1]));
    out += line("Field", fmt::format("{:.1f}° × {:.1f}° (10 %)", f.field[0], f.field[1]));
    out += line("Symmetry", symmetry_name(f.symmetry));
    out += line("Opening", opening_text(p.opening));
    if (p.housing)
        out += line("Housing", fmt::format("{} × {} × {} m", human_number(p.housing->x),
                                           human_number(p.housing->y), human_number(p.housing->z)));
    if (!p.tilt.angles.empty())
        out += line("Tilt", fmt::format("light output changes with tilt, {} factors",
                                        p.tilt.angles.size()));
    for (const Problem& problem : lamp_.warnings)
        out += fmt::format("\nProblem: {}: {}\n", problem.place.text(), problem.what);
    return out;
}

std::string LampReport::json() const {
    const Photometry& p = lamp_.photometry;
    const LampFigures& f = figures_;
    const auto optional = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    Json out{{"kind", "lamp"},
             {"file", file_.string()},
             {"format", lamp_.format},
             {"name", p.name},
             {"maker", p.maker},
             {"catalogue", p.catalogue},
             {"lamp", p.lamp},
             {"lamp_sets", lamp_.lamp_sets},
             {"absolute", p.absolute},
             {"lamp_lumens", optional(p.lamp_lumens)},
             {"watts", optional(p.watts)},
             {"flux", f.flux},
             {"downward", f.downward},
             {"output_ratio", optional(f.output_ratio)},
             {"stated_output_ratio", optional(p.stated_lor)},
             {"efficacy", optional(f.efficacy)},
             {"peak", {{"candela", f.peak}, {"c", f.peak_c}, {"gamma", f.peak_gamma}}},
             {"beam", f.beam},
             {"field", f.field},
             {"symmetry", symmetry_name(f.symmetry)},
             {"opening", opening_text(p.opening)}};
    Json& problems = out["problems"] = Json::array();
    for (const Problem& problem : lamp_.warnings)
        problems.push_back({{"place", problem.place.text()}, {"what", problem.what}});
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace exitance::cli
