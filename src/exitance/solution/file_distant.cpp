// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_distant.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace exitance::solution_file {

using nlohmann::json;

namespace {

constexpr double most = 1e300;
constexpr std::uint64_t finest_map = 12;

json json_of(const Vec3& v) {
    return json::array({v.x, v.y, v.z});
}

json json_of(const SkyModel& m) {
    return {{"coefficients", {m.a, m.b, m.c, m.d, m.e}},
            {"circumsolar_offset", m.circumsolar_offset},
            {"traditional_overcast", m.traditional_overcast},
            {"scale", m.scale},
            {"sun", json_of(m.sun)}};
}

Vec3 read_direction(const Node& node) {
    const Vec3 v = node.vector();
    if (!(std::abs(length(v) - 1) < 1e-6)) node.refuse("a unit vector");
    return v;
}

SkyModel read_model(const Node& node) {
    SkyModel m;
    const Node k = node["coefficients"];
    if (k.size() != 5) k.refuse("five numbers");
    double* const letters[5] = {&m.a, &m.b, &m.c, &m.d, &m.e};
    for (std::size_t i = 0; i < 5; ++i) *letters[i] = k[i].number_within(-1e6, 1e6);
    m.circumsolar_offset = node["circumsolar_offset"].number_within(0, 1);
    m.traditional_overcast = node["traditional_overcast"].flag();
    m.scale = node["scale"].number_within(0, most);
    m.sun = read_direction(node["sun"]);
    return m;
}

RadianceMap read_map(const Node& node) {
    RadianceMap map;
    map.level = static_cast<std::uint32_t>(node["level"].index_below(finest_map));
    const Node cells = node["cells"];
    const std::uint64_t wanted = std::uint64_t{6} << (2 * map.level);
    if (cells.size() != wanted) cells.refuse(std::to_string(wanted) + " numbers");
    for (std::size_t i = 0; i < wanted; ++i)
        map.cells.push_back(static_cast<float>(cells[i].number_within(0, 1e38)));
    return map;
}

}  // namespace

void add_distant_lights(json& extras, const Solution& solution) {
    if (solution.distant.empty()) return;
    json list = json::array();
    for (const SolutionDistantLight& placed : solution.distant) {
        const DistantLight& l = placed.light;
        json entry{{"name", l.name}, {"colour", l.colour}, {"group", placed.group}};
        if (l.kind == DistantLight::Kind::disc) {
            entry["sun"] = {{"direction", json_of(l.direction)},
                            {"diameter", l.diameter},
                            {"irradiance", l.irradiance}};
        } else {
            entry["strength"] = l.strength;
            entry["ground"] = l.ground;
            if (l.map)
                entry["map"] = {{"level", l.map->level}, {"cells", l.map->cells}};
            else
                entry["sky"] = json_of(l.model);
        }
        list.push_back(std::move(entry));
    }
    extras["distant_lights"] = std::move(list);
}

void read_distant_lights(const Node& extras, Solution& solution) {
    if (!extras.has("distant_lights")) return;
    const Node list = extras["distant_lights"];
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Node node = list[i];
        SolutionDistantLight placed;
        DistantLight& l = placed.light;
        l.name = node["name"].text();
        l.colour = node["colour"].spectrum(solution.bands.size(), most);
        if (node.has("sun")) {
            const Node sun = node["sun"];
            l.direction = read_direction(sun["direction"]);
            l.diameter = sun["diameter"].number_within(0, 3);
            l.irradiance = sun["irradiance"].number_within(0, most);
        } else {
            l.kind = DistantLight::Kind::sky;
            l.strength = node["strength"].number_within(0, most);
            l.ground = node["ground"].number_within(0, most);
            if (node.has("map"))
                l.map = std::make_shared<const RadianceMap>(read_map(node["map"]));
            else
                l.model = read_model(node["sky"]);
        }
        placed.group =
            static_cast<std::uint32_t>(node["group"].index_below(solution.groups.size()));
        solution.distant.push_back(std::move(placed));
    }
}

}  // namespace exitance::solution_file
