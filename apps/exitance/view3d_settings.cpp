// SPDX-License-Identifier: Apache-2.0
#include "view3d_settings.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "exitance/run/error.h"

namespace exitance::cli {

namespace {

double number(const std::string& key, const std::string& text, const Place& place) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || rest != end || !std::isfinite(value))
        throw Error(place, fmt::format("C {}={}, expected a number", key, text));
    return value;
}

}  // namespace

std::vector<Setting> view3d_settings(const Scene& scene, const std::filesystem::path& file) {
    std::vector<Setting> settings;
    const Place place{file.string()};
    for (const auto& [key, text] : scene.form_factors.options) {
        const auto set = [&](const char* name, const std::string& value) {
            settings.push_back({name, value, place});
        };
        if (key == "eps") {
            set("accuracy", text);
        } else if (key == "encl") {
            if (number(key, text, place) != 0) set("enforce", "both");
        } else if (key == "emit") {
            if (number(key, text, place) != 0) set("interchange", "true");
        } else if (key == "out") {
            if (number(key, text, place) == 1) set("view3d-binary", "true");
        } else if (key == "list") {
            if (number(key, text, place) != 0) set("list", "true");
        } else if (key == "row" || key == "col") {
            if (number(key, text, place) != 0) set(key.c_str(), text);
        }
    }
    return settings;
}

}  // namespace exitance::cli
