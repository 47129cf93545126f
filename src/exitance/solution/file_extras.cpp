// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_extras.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exitance/solution/file_distant.h"
#include "exitance/solution/file_layout.h"
#include "exitance/solution/file_luminaires.h"

namespace exitance::solution_file {

using nlohmann::json;

namespace {

json json_of(const Vec3& v) {
    return json::array({v.x, v.y, v.z});
}

json json_of(const Camera& camera) {
    json out{{"name", camera.name},
             {"eye", json_of(camera.eye)},
             {"look_at", json_of(camera.look_at)},
             {"up", json_of(camera.up)},
             {"fov_y", camera.fov_y}};
    if (camera.aspect) out["aspect"] = *camera.aspect;
    if (camera.near) out["near"] = *camera.near;
    if (camera.far) out["far"] = *camera.far;
    return out;
}

json json_of(const SensorGrid& grid) {
    return {{"name", grid.name},
            {"origin", json_of(grid.origin)},
            {"u", json_of(grid.u)},
            {"v", json_of(grid.v)},
            {"columns", grid.columns},
            {"rows", grid.rows},
            {"normal", json_of(grid.normal)}};
}

Camera read_camera(const Node& node) {
    Camera camera;
    camera.name = node["name"].text();
    camera.eye = node["eye"].vector();
    camera.look_at = node["look_at"].vector();
    camera.up = node["up"].vector();
    camera.fov_y = node["fov_y"].number();
    if (node.has("aspect")) camera.aspect = node["aspect"].number();
    if (node.has("near")) camera.near = node["near"].number();
    if (node.has("far")) camera.far = node["far"].number();
    return camera;
}

SensorGrid read_grid(const Node& node) {
    SensorGrid grid;
    grid.name = node["name"].text();
    grid.origin = node["origin"].vector();
    grid.u = node["u"].vector();
    grid.v = node["v"].vector();
    grid.normal = node["normal"].vector();
    grid.columns = static_cast<std::uint32_t>(node["columns"].index_below(1u << 31));
    grid.rows = static_cast<std::uint32_t>(node["rows"].index_below(1u << 31));
    return grid;
}

const char* stopped_by(Ended ended) {
    return ended == Ended::out_of_time ? "time" : "interrupt";
}

Ended read_stopped(const Node& node) {
    for (const Ended ended : {Ended::out_of_time, Ended::cancelled})
        if (node.text() == stopped_by(ended)) return ended;
    node.refuse("time or interrupt");
}

Quantity read_quantity(const Node& node) {
    for (const Quantity q : {Quantity::unitless, Quantity::radiometric, Quantity::photometric})
        if (node.text() == quantity_name(q)) return q;
    node.refuse("unitless, radiometric or photometric");
}

}  // namespace

json extras_of(const Material& material) {
    json out{{"reflectance", material.reflectance},
             {"exitance", material.exitance},
             {"two_sided", material.two_sided}};
    if (!material.group.empty()) out["group"] = material.group;
    if (material.clear_transmittance() > 0) out["transmittance"] = material.transmittance;
    if (material.reflectance_file) out["reflectance_file"] = *material.reflectance_file;
    if (material.reflectance_pattern)
        out["reflectance_pattern"] = {{"factor", material.reflectance_pattern.factor},
                                      {"most", material.reflectance_pattern.texture->most()}};
    if (material.exitance_pattern)
        out["exitance_pattern"] = {{"factor", material.exitance_pattern.factor},
                                   {"most", material.exitance_pattern.texture->most()}};
    return out;
}

json extras_of(const Solution& s) {
    json groups = json::array(), cameras = json::array(), grids = json::array();
    for (const LightGroup& g : s.groups) groups.push_back({{"name", g.name}, {"weight", g.weight}});
    for (const Camera& camera : s.cameras) cameras.push_back(json_of(camera));
    for (const SensorGrid& grid : s.grids) grids.push_back(json_of(grid));
    json out{{"format", format_version},
             {"title", s.title},
             {"quantity", quantity_name(s.quantity)},
             {"exitance_unit", exitance_unit(s.quantity)},
             {"irradiance_unit", irradiance_unit(s.quantity)},
             {"bands", s.bands},
             {"up", json_of(s.up)},
             {"groups", groups},
             {"energy",
              {{"emitted", s.energy.emitted},
               {"absorbed", s.energy.absorbed},
               {"absorbed_behind", s.energy.absorbed_behind},
               {"escaped", s.energy.escaped},
               {"unshot", s.energy.unshot},
               {"unit", flux_unit(s.quantity)}}},
             {"options", s.options},
             {"counters", s.counters},
             {"scene_digest", s.scene_digest},
             {"cameras", cameras},
             {"grids", grids}};
    if (s.error)
        out["error"] = {{"rms", s.error->rms},
                        {"confidence", s.error->confidence},
                        {"points", s.error->points}};
    if (s.ended != Ended::converged) out["stopped"] = stopped_by(s.ended);
    if (s.refined_for) {
        json& refined = out["refined_for"] = json::object();
        if (s.refined_for->camera) refined["camera"] = *s.refined_for->camera;
        if (s.refined_for->grid) refined["grid"] = *s.refined_for->grid;
    }
    add_luminaires(out, s);
    add_distant_lights(out, s);
    if (!s.light_scenes.empty()) {
        json scenes = json::array();
        for (const LightScene& scene : s.light_scenes)
            scenes.push_back({{"name", scene.name}, {"factors", scene.factors}});
        out["scenes"] = std::move(scenes);
    }
    return out;
}

void Node::refuse(const std::string& expected) const {
    std::string found = value_->dump(-1, ' ', false, json::error_handler_t::replace);
    if (found.size() > 40) found = found.substr(0, 37) + "...";
    throw Error(Place{*file_}, fmt::format("{}: found {}, expected {}",
                                           path_.empty() ? "JSON" : path_, found, expected));
}

Node Node::operator[](const std::string& key) const {
    if (!value_->is_object()) refuse("an object");
    const auto entry = value_->find(key);
    if (entry == value_->end()) refuse("a member '" + key + "'");
    return {*file_, *entry, path_.empty() ? key : path_ + "." + key};
}

Node Node::operator[](std::size_t index) const {
    if (index >= size()) refuse(fmt::format("at least {} entries", index + 1));
    return {*file_, (*value_)[index], fmt::format("{}[{}]", path_, index)};
}

bool Node::has(const std::string& key) const {
    return value_->is_object() && value_->contains(key);
}

std::size_t Node::size() const {
    if (!value_->is_array()) refuse("an array");
    return value_->size();
}

std::vector<std::string> Node::keys() const {
    if (!value_->is_object()) refuse("an object");
    std::vector<std::string> out;
    for (const auto& [key, value] : value_->items()) out.push_back(key);
    return out;
}

double Node::number() const {
    if (!value_->is_number()) refuse("a number");
    return value_->get<double>();
}

double Node::number_within(double least, double most) const {
    const double value = number();
    if (!(value >= least && value <= most))
        refuse(std::isfinite(most) ? fmt::format("{:g} … {:g}", least, most)
                                   : fmt::format("at least {:g}", least));
    return value;
}

std::uint64_t Node::count() const {
    if (!value_->is_number_unsigned()) refuse("a count");
    return value_->get<std::uint64_t>();
}

std::uint64_t Node::index_below(std::uint64_t limit) const {
    if (count() >= limit) refuse(fmt::format("an index below {}", limit));
    return count();
}

const std::string& Node::text() const {
    if (!value_->is_string()) refuse("a text");
    return value_->get_ref<const std::string&>();
}

bool Node::flag() const {
    if (!value_->is_boolean()) refuse("true or false");
    return value_->get<bool>();
}

Vec3 Node::vector() const {
    if (size() != 3) refuse("three numbers");
    const Node& self = *this;
    return {self[std::size_t{0}].number(), self[1].number(), self[2].number()};
}

Spectrum Node::spectrum(std::size_t bands, double most) const {
    if (size() != bands) refuse(fmt::format("{} values, one per band", bands));
    Spectrum out(bands);
    for (std::size_t b = 0; b < bands; ++b) out[b] = (*this)[b].number_within(0, most);
    return out;
}

void read_extras(const Node& extras, Solution& s) {
    if (extras["format"].count() != format_version)
        extras["format"].refuse(fmt::format("{}", format_version));
    s.title = extras["title"].text();
    s.quantity = read_quantity(extras["quantity"]);
    s.up = extras["up"].vector();
    if (!(length(s.up) > 0)) extras["up"].refuse("a direction");
    s.bands.clear();
    const Node bands = extras["bands"], groups = extras["groups"];
    for (std::size_t i = 0; i < bands.size(); ++i) s.bands.push_back(bands[i].text());
    if (s.bands.empty() || s.bands.size() > 4096) bands.refuse("1 … 4096 bands");
    for (std::size_t i = 0; i < groups.size(); ++i)
        s.groups.push_back({groups[i]["name"].text(), groups[i]["weight"].number()});
    if (s.groups.empty() || s.groups.size() > 1'000'000) groups.refuse("1 … 1000000 groups");

    const Node energy = extras["energy"];
    s.energy = {energy["emitted"].number(), energy["absorbed"].number(),
                energy["absorbed_behind"].number(), energy["escaped"].number(),
                energy["unshot"].number()};
    if (extras.has("error")) {
        const Node error = extras["error"];
        s.error =
            ErrorEstimate{error["rms"].number(), error["confidence"].number(),
                          static_cast<std::uint32_t>(error["points"].index_below(1ull << 32))};
    }
    if (extras.has("stopped")) s.ended = read_stopped(extras["stopped"]);
    if (extras.has("refined_for")) {
        const Node refined = extras["refined_for"];
        s.refined_for.emplace();
        if (refined.has("camera")) s.refined_for->camera = refined["camera"].text();
        if (refined.has("grid")) s.refined_for->grid = refined["grid"].text();
        if (!s.refined_for->camera && !s.refined_for->grid)
            refined.refuse("the name of a camera or a grid");
    }
    const Node options = extras["options"], counters = extras["counters"];
    for (const std::string& key : options.keys()) s.options[key] = options[key].text();
    for (const std::string& key : counters.keys()) s.counters[key] = counters[key].number();
    s.scene_digest = extras["scene_digest"].text();
    const Node cameras = extras["cameras"], grids = extras["grids"];
    for (std::size_t i = 0; i < cameras.size(); ++i) s.cameras.push_back(read_camera(cameras[i]));
    for (std::size_t i = 0; i < grids.size(); ++i) s.grids.push_back(read_grid(grids[i]));
    read_luminaires(extras, s);
    read_distant_lights(extras, s);
    for (std::size_t i = 0; extras.has("scenes") && i < extras["scenes"].size(); ++i) {
        const Node node = extras["scenes"][i], factors = node["factors"];
        LightScene scene;
        scene.name = node["name"].text();
        for (const std::string& group : factors.keys())
            scene.factors[group] = factors[group].number_within(-1e9, 1e9);
        s.light_scenes.push_back(std::move(scene));
    }
}

Material read_material(const Node& node, std::size_t bands) {
    Material material;
    material.name = node["name"].text();
    const Node extras = node["extras"]["exitance"];
    material.reflectance = extras["reflectance"].spectrum(bands, 1);
    material.exitance = extras["exitance"].spectrum(bands, std::numeric_limits<double>::infinity());
    material.two_sided = extras["two_sided"].flag();
    if (extras.has("transmittance"))
        material.transmittance = extras["transmittance"].spectrum(bands, 1);
    if (extras.has("group")) material.group = extras["group"].text();
    if (extras.has("reflectance_file")) {
        const double number = extras["reflectance_file"].number_within(-1e9, 1e9);
        material.reflectance_file = static_cast<int>(number);
    }
    return material;
}

}  // namespace exitance::solution_file
