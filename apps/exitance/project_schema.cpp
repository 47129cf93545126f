// SPDX-License-Identifier: Apache-2.0
#include "project_schema.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/project_keys.h"
#include "exitance/solve/options.h"

namespace exitance::cli {

namespace {

using json = nlohmann::ordered_json;

json numbers(int count) {
    return {{"type", "array"},
            {"items", {{"type", "number"}}},
            {"minItems", count},
            {"maxItems", count}};
}

json type_of(ProjectKey::Kind kind) {
    switch (kind) {
        case ProjectKey::Kind::text:
            return {{"type", "string"}};
        case ProjectKey::Kind::number:
            return {{"type", "number"}};
        case ProjectKey::Kind::count:
            return {{"type", "integer"}, {"minimum", 1}};
        case ProjectKey::Kind::flag:
            return {{"type", "boolean"}};
        case ProjectKey::Kind::pair:
            return numbers(2);
        case ProjectKey::Kind::vector:
            return numbers(3);
        case ProjectKey::Kind::turn:
            return numbers(4);
        case ProjectKey::Kind::spectrum:
            return {{"oneOf", {{{"type", "number"}}, numbers(3)}}};
        case ProjectKey::Kind::points:
            return {{"type", "array"}, {"items", numbers(3)}, {"minItems", 3}, {"maxItems", 4}};
        case ProjectKey::Kind::time:
            return {{"type", "string"}, {"format", "date-time"}};
        case ProjectKey::Kind::unit:
            return {{"type", {"string", "number"}}};
    }
    return json::object();
}

json schema_of(const ProjectTable& table) {
    json properties = json::object(), required = json::array();
    for (const ProjectKey& key : table.keys) {
        json entry = type_of(key.kind);
        entry["description"] = key.what;
        if (!key.choices.empty()) entry["enum"] = key.choices;
        properties[key.name] = std::move(entry);
        if (key.required) required.push_back(key.name);
    }
    json out{{"type", "object"}, {"description", table.what}, {"properties", properties}};
    if (!required.empty()) out["required"] = required;
    if (table.open)
        out["additionalProperties"] = {{"type", {"string", "number", "boolean"}}};
    else
        out["additionalProperties"] = false;
    return out;
}

json schema_of(const Option& option) {
    const auto is = [&](auto* kind) {
        return std::holds_alternative<decltype(kind)>(option.target);
    };
    const bool text = std::holds_alternative<std::string*>(option.target) ||
                      std::holds_alternative<std::optional<std::string>*>(option.target);
    json out{{"type", option.is_flag() ? "boolean"
                      : text           ? "string"
                      : is(static_cast<int*>(nullptr)) || is(static_cast<std::uint64_t*>(nullptr))
                          ? "integer"
                          : "number"},
             {"description", option.what}};
    if (!option.choices.empty()) out["enum"] = option.choices;
    if (!text && std::isfinite(option.least)) out["minimum"] = option.least;
    if (!text && std::isfinite(option.most)) out["maximum"] = option.most;
    return out;
}

}  // namespace

std::string project_schema() {
    json root;
    for (const ProjectTable& table : project_tables()) {
        json entry = schema_of(table);
        if (table.name.empty()) {
            root = std::move(entry);
            continue;
        }
        if (table.name == "solve") {
            SolveOptions options;
            for (const Option& option : describe(options))
                entry["properties"][option.name] = schema_of(option);
            entry["additionalProperties"] = false;
        }
        if (table.repeated) entry = {{"type", "array"}, {"items", std::move(entry)}};
        root["properties"][table.name] = std::move(entry);
    }
    json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
             {"title", "Exitance lighting project"}};
    out.update(root);
    return out.dump(2) + "\n";
}

}  // namespace exitance::cli
