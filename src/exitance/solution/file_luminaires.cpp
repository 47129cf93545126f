// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_luminaires.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace exitance::solution_file {

using nlohmann::json;

namespace {

constexpr std::array<const char*, 4> shapes{"point", "box", "cylinder", "ellipsoid"};

json json_of(const Vec3& v) {
    return json::array({v.x, v.y, v.z});
}

json json_of(const Photometry& p) {
    return {{"planes", p.planes},
            {"gammas", p.gammas},
            {"candela", p.candela},
            {"opening",
             {{"shape", shapes[static_cast<std::size_t>(p.opening.shape)]},
              {"size", json_of(p.opening.size)},
              {"axis", p.opening.axis},
              {"sides_shine", p.opening.sides_shine},
              {"sides", p.opening.sides}}}};
}

std::vector<double> read_numbers(const Node& node, double least, double most) {
    std::vector<double> out;
    for (std::size_t i = 0; i < node.size(); ++i) out.push_back(node[i].number_within(least, most));
    return out;
}

std::vector<double> read_angles(const Node& node, double most) {
    std::vector<double> out = read_numbers(node, 0, most);
    for (std::size_t i = 1; i < out.size(); ++i)
        if (!(out[i] > out[i - 1])) node[i].refuse("an angle above the one before");
    return out;
}

LuminousOpening read_opening(const Node& node) {
    LuminousOpening out;
    const auto shape = std::find(shapes.begin(), shapes.end(), node["shape"].text());
    if (shape == shapes.end()) node["shape"].refuse("point, box, cylinder or ellipsoid");
    out.shape = static_cast<LuminousOpening::Shape>(shape - shapes.begin());
    for (std::size_t i = 0; i < 3; ++i) out.size[i] = node["size"][i].number_within(0, 1e9);
    out.axis = static_cast<std::uint32_t>(node["axis"].index_below(3));
    out.sides_shine = node["sides_shine"].flag();
    for (std::size_t i = 0; i < 4; ++i) out.sides[i] = node["sides"][i].number_within(0, 1e9);
    return out;
}

Photometry read_photometry(const Node& node) {
    Photometry out;
    out.planes = read_angles(node["planes"], 360);
    const bool round = out.planes.size() == 1;
    if (out.planes.empty() || out.planes.front() != 0 || (!round && out.planes.back() != 360))
        node["planes"].refuse("angles from 0 to 360, or 0 alone");
    out.gammas = read_angles(node["gammas"], 180);
    if (out.gammas.size() < 2) node["gammas"].refuse("two angles at least");
    out.candela = read_numbers(node["candela"], 0, 1e300);
    if (out.candela.size() != out.planes.size() * out.gammas.size())
        node["candela"].refuse("one value per angle of each plane");
    out.opening = read_opening(node["opening"]);
    return out;
}

}  // namespace

void add_luminaires(json& extras, const Solution& solution) {
    if (solution.luminaires.empty()) return;
    std::vector<const Photometry*> kept;
    json photometries = json::array(), luminaires = json::array();
    for (const SolutionLuminaire& placed : solution.luminaires) {
        const Luminaire& l = placed.luminaire;
        auto found = std::find(kept.begin(), kept.end(), l.photometry.get());
        if (found == kept.end()) {
            photometries.push_back(json_of(*l.photometry));
            found = kept.insert(kept.end(), l.photometry.get());
        }
        luminaires.push_back({{"name", l.name},
                              {"photometry", found - kept.begin()},
                              {"position", json_of(l.position)},
                              {"c0", json_of(l.c0)},
                              {"nadir", json_of(l.nadir)},
                              {"multiplier", l.multiplier},
                              {"colour", l.colour},
                              {"group", placed.group}});
    }
    extras["photometries"] = std::move(photometries);
    extras["luminaires"] = std::move(luminaires);
}

void read_luminaires(const Node& extras, Solution& solution) {
    if (!extras.has("luminaires")) return;
    const Node list = extras["luminaires"], tables = extras["photometries"];
    std::vector<std::shared_ptr<const Photometry>> photometries;
    for (std::size_t i = 0; i < tables.size(); ++i)
        photometries.push_back(std::make_shared<const Photometry>(read_photometry(tables[i])));
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Node node = list[i];
        SolutionLuminaire placed;
        Luminaire& l = placed.luminaire;
        l.name = node["name"].text();
        l.photometry = photometries[node["photometry"].index_below(photometries.size())];
        l.position = node["position"].vector();
        l.c0 = node["c0"].vector();
        l.nadir = node["nadir"].vector();
        const auto near = [](double x, double y) { return std::abs(x - y) < 1e-6; };
        if (!near(length(l.c0), 1) || !near(length(l.nadir), 1) || !near(dot(l.c0, l.nadir), 0))
            node.refuse("unit vectors c0 and nadir at right angles");
        l.multiplier = node["multiplier"].number_within(0, 1e300);
        l.colour = node["colour"].spectrum(solution.bands.size(), 1e300);
        placed.group =
            static_cast<std::uint32_t>(node["group"].index_below(solution.groups.size()));
        solution.luminaires.push_back(std::move(placed));
    }
}

}  // namespace exitance::solution_file
