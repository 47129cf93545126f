// SPDX-License-Identifier: Apache-2.0
// What info says, as JSON.
#include <nlohmann/json.hpp>

#include "exitance/scene/spectrum.h"
#include "reached_error.h"
#include "scene_report.h"

namespace exitance::cli {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json json_of(const Box& box) {
    if (box.empty()) return nullptr;
    return {{"lower", json_of(box.lower)}, {"upper", json_of(box.upper)}};
}

Json json_of(const Place& place) {
    Json out = Json::object();
    if (!place.file.empty()) out["file"] = place.file;
    if (place.line > 0) out["line"] = place.line;
    if (place.column > 0) out["column"] = place.column;
    return out;
}

Json json_of(const std::vector<Camera>& cameras) {
    Json out = Json::array();
    for (const Camera& c : cameras)
        out.push_back({{"name", c.name},
                       {"eye", json_of(c.eye)},
                       {"look_at", json_of(c.look_at)},
                       {"up", json_of(c.up)},
                       {"fov", c.fov_y}});
    return out;
}

Json json_of(const std::vector<SensorGrid>& grids) {
    Json out = Json::array();
    for (const SensorGrid& g : grids)
        out.push_back({{"name", g.name},
                       {"origin", json_of(g.origin)},
                       {"u", json_of(g.u)},
                       {"v", json_of(g.v)},
                       {"normal", json_of(g.normal)},
                       {"columns", g.columns},
                       {"rows", g.rows}});
    return out;
}

Json json_of(const std::vector<LightScene>& scenes) {
    Json out = Json::array();
    for (const LightScene& s : scenes) out.push_back({{"name", s.name}, {"factors", s.factors}});
    return out;
}

Json json_of(const std::vector<DistantLight>& lights, const Vec3& up) {
    Json out = Json::array();
    for (const DistantLight& light : lights) {
        Json& entry = out.emplace_back(Json{{"name", light.name}});
        if (light.kind == DistantLight::Kind::sky) {
            entry["kind"] = "sky";
            entry["horizontal"] = horizontal_irradiance(light);
            continue;
        }
        entry["kind"] = "sun";
        entry["normal"] = light.irradiance;
        entry["direction"] = json_of(light.direction);
        if (const auto angles = sky_angles(light.direction, up)) {
            entry["altitude"] = angles->altitude;
            entry["azimuth"] = angles->azimuth;
        }
    }
    return out;
}

const char* quantity_name(Quantity quantity) {
    if (quantity == Quantity::photometric) return "photometric";
    return quantity == Quantity::radiometric ? "radiometric" : "unitless";
}

std::string lines(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string SceneReport::json() const {
    Json out{{"kind", "scene"},
             {"file", file_.string()},
             {"title", scene_.title},
             {"quantity", quantity_name(scene_.quantity)},
             {"polygons", scene_.polygons.size()},
             {"triangles", triangles_},
             {"quads", quads_},
             {"surfaces", scene_.surfaces.size()},
             {"area", area_},
             {"bounds", json_of(bounds_)},
             {"flux", flux_},
             {"flux_unit", flux_unit(scene_.quantity)}};
    Json& materials = out["materials"] = Json::array();
    for (const MaterialFacts& facts : materials_) {
        materials.push_back({{"name", facts.material->name},
                             {"reflectance", facts.material->reflectance},
                             {"luminous_reflectance", luminance(facts.material->reflectance)},
                             {"exitance", facts.material->exitance},
                             {"specular", facts.material->specular},
                             {"transmittance", facts.material->transmittance},
                             {"diffuse_transmittance", facts.material->diffuse_transmittance},
                             {"two_sided", facts.material->two_sided},
                             {"area", facts.area},
                             {"polygons", facts.polygons}});
        for (const auto& [key, pattern] :
             {std::pair{"reflectance_texture", &facts.material->reflectance_pattern},
              std::pair{"exitance_texture", &facts.material->exitance_pattern}})
            if (*pattern)
                materials.back()[key] = {pattern->texture->picture().width,
                                         pattern->texture->picture().height};
    }
    Json& groups = out["groups"] = Json::array();
    if (flux_ > 0 || !scene_.distant.empty())
        for (const LampFacts& group : groups_)
            groups.push_back({{"name", group.name},
                              {"flux", group.flux},
                              {"area", group.area},
                              {"surfaces", group.surfaces},
                              {"luminaires", group.luminaires},
                              {"distant", group.distant}});
    out["distant"] = json_of(scene_.distant, scene_.up);
    out["cameras"] = json_of(scene_.cameras);
    out["grids"] = json_of(scene_.grids);
    out["scenes"] = json_of(scene_.light_scenes);
    Json& settings = out["settings"] = Json::object();
    for (const Setting& setting : scene_.settings) settings[setting.name] = setting.value;
    Json& notes = out["notes"] = Json::array();
    for (const Problem& note : scene_.notes)
        notes.push_back({{"place", json_of(note.place)}, {"what", note.what}});
    Json& problems = out["problems"] = Json::array();
    for (const Problem& problem : problems_)
        problems.push_back({{"place", json_of(problem.place)}, {"what", problem.what}});
    return lines(out);
}

std::string SolutionReport::json() const {
    const EnergyBalance& energy = solution_.energy;
    Json out{{"kind", "solution"},
             {"file", file_.string()},
             {"title", solution_.title},
             {"quantity", quantity_name(solution_.quantity)},
             {"vertices", solution_.positions.size()},
             {"triangles", solution_.triangles.size()},
             {"bounds", json_of(bounds_)},
             {"flux_unit", flux_unit(solution_.quantity)},
             {"energy",
              {{"emitted", energy.emitted},
               {"absorbed", energy.absorbed},
               {"absorbed_behind", energy.absorbed_behind},
               {"escaped", energy.escaped},
               {"unshot", energy.unshot}}}};
    out["refined_for"] = nullptr;
    if (solution_.refined_for) {
        out["refined_for"] = nlohmann::json::object();
        if (solution_.refined_for->camera)
            out["refined_for"]["camera"] = *solution_.refined_for->camera;
        if (solution_.refined_for->grid) out["refined_for"]["grid"] = *solution_.refined_for->grid;
    }
    out["error"] = nullptr;
    if (solution_.error)
        out["error"] = {{"rms", solution_.error->rms},
                        {"confidence", solution_.error->confidence},
                        {"points", solution_.error->points}};
    const auto aim = aim_of(solution_);
    const auto is = aim ? reached(solution_, *aim) : std::nullopt;
    out["error_reached"] = is ? Json(*is) : Json(nullptr);
    out["stopped"] = solution_.ended == Ended::converged     ? Json(nullptr)
                     : solution_.ended == Ended::out_of_time ? Json("time")
                                                             : Json("interrupt");
    Json& groups = out["groups"] = Json::array();
    for (const LightGroup& group : solution_.groups)
        groups.push_back({{"name", group.name}, {"weight", group.weight}});
    out["options"] = solution_.options;
    out["counters"] = solution_.counters;
    out["cameras"] = json_of(solution_.cameras);
    out["grids"] = json_of(solution_.grids);
    out["scenes"] = json_of(solution_.light_scenes);
    return lines(out);
}

}  // namespace exitance::cli
