// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/daylight.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "exitance/scene/formats/environment_map.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/luminaire_keys.h"
#include "exitance/scene/formats/named_file.h"
#include "exitance/scene/formats/project_keys.h"
#include "exitance/scene/formats/toml_direction.h"
#include "exitance/scene/merge.h"
#include "exitance/scene/sun_position.h"

namespace exitance {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double most = limits::exitance;

// Daylight availability (IESNA RP-21, after Gillette, Pierpoint & Treado 1984), in lux: what falls
// outside of the atmosphere, and the laws of a clear sky, a partly cloudy one and an overcast one.
constexpr double outside_atmosphere = 127'500;
struct Availability {
    double extinction, least, range, power;
};
constexpr Availability clear_day{0.21, 800, 15'500, 0.5}, partly_cloudy_day{0.80, 300, 45'000, 1},
    overcast_day{0, 300, 21'000, 1};

double sky_illuminance(const Availability& day, double altitude) {
    return altitude > 0 ? day.least + day.range * std::pow(std::sin(altitude), day.power) : 0;
}

double sun_illuminance(const Availability& day, double altitude, int day_of_year) {
    if (!(altitude > 0)) return 0;
    const double orbit = 1 + 0.034 * std::cos(2 * std::numbers::pi * (day_of_year - 2) / 365);
    return outside_atmosphere * orbit * std::exp(-day.extinction / std::sin(altitude));
}

class DaylightReader {
  public:
    DaylightReader(Scene& scene, const TomlTable& project, const std::filesystem::path& folder,
                   const ReadOptions& options)
        : scene_(scene),
          folder_(folder),
          options_(options),
          site_(project.table("site", project_keys("site"))),
          sky_(project.table("sky", project_keys("sky"))),
          sun_(project.table("sun", project_keys("sun"))) {}

    void read() {
        if (!sky_ && !sun_) return;
        find_sun();
        if (sky_) read_sky();
        if (sun_) read_sun();
    }

  private:
    // Towards the sun, from [sun] or from place and time.
    void find_sun() {
        if (sun_) {
            const bool angles = sun_->has("altitude") || sun_->has("azimuth");
            if (angles && sun_->has("direction"))
                throw Error(sun_->place("direction"),
                            "found both 'direction' and angles, expected one of them");
            if (angles) {
                sun_->require("altitude");
                SunPosition given;
                given.altitude = *sun_->number("altitude", -90, 90) * degree;
                given.azimuth = sun_->number("azimuth", -360, 360).value_or(180) * degree;
                to_sun_ = sun_direction(given, north());
            } else if (sun_->has("direction")) {
                to_sun_ = direction(*sun_, "direction", {});
            }
        }
        if (site_) {
            for (const char* key : {"latitude", "longitude", "time"}) site_->require(key);
            auto time = *site_->time("time");
            if (const auto zone = site_->number("time_zone", -14, 14)) {
                if (time.has_zone)
                    throw Error(site_->place("time_zone"),
                                "found both 'time_zone' and an offset in 'time', expected one of "
                                "them");
                time.moment.zone = *zone;
            } else if (!time.has_zone) {
                site_->refuse("time_zone", "hours ahead of universal time, or an offset in 'time'");
            }
            day_ = time.moment.day_of_year();
            const SunPosition position =
                sun_position(*site_->number("latitude", -90, 90),
                             *site_->number("longitude", -180, 180), time.moment);
            if (!to_sun_) to_sun_ = sun_direction(position, north());
        }
        if (!to_sun_) return;
        altitude_ = std::asin(std::clamp(to_sun_->y, -1.0, 1.0));
        if (*altitude_ < 0 && !(sun_ && sun_->has("direction")))
            scene_.notes.push_back({sun_ ? sun_->place() : site_->place(),
                                    fmt::format("the sun is {:.1f}° below the horizon: it is night",
                                                -*altitude_ / degree)});
    }

    double north() const { return site_ ? site_->number("north", -360, 360).value_or(0) : 0; }

    [[noreturn]] void demand_sun(const TomlTable& table, const std::string& why) const {
        throw Error(table.place(),
                    why +
                        " needs to know where the sun stands: [site] with latitude, longitude "
                        "and time, or the altitude or direction in [sun]");
    }

    // A number in lux of the laws above, in the unit of the scene.
    double in_units(double lux) const {
        return scene_.quantity == Quantity::radiometric ? lux / luminous_efficacy : lux;
    }

    void read_sky() {
        sky_->require("model");
        const std::string model = *sky_->text("model");
        DistantLight light;
        light.kind = DistantLight::Kind::sky;
        light.name = sky_->text("name").value_or("sky");
        light.group = sky_->text("group").value_or(light.name);
        light.place = sky_->place();
        light.colour = lamp_colour(*sky_);
        const double factor = lamp_factor(*sky_);
        if (model == "map") {
            read_map(light, factor);
        } else {
            refuse_keys(*sky_, "sky model \"" + model + "\"", {"file", "rotation", "scale"});
            if (model != "cie") refuse_keys(*sky_, "sky model \"" + model + "\"", {"type"});
            if (model != "perez")
                refuse_keys(*sky_, "sky model \"" + model + "\"",
                            {"direct_normal", "diffuse_horizontal"});
            const double expected = read_model(light, model);
            set_level(light, expected);
            light.strength *= factor;
        }
        scene_.distant.push_back(std::move(light));
    }

    void read_map(DistantLight& light, double factor) {
        for (const char* key : {"type", "zenith_luminance", "horizontal", "direct_normal",
                                "diffuse_horizontal", "ground_reflectance"})
            refuse_keys(*sky_, "sky model \"map\"", {key});
        sky_->require("file");
        light.strength = factor * sky_->number("scale", 0, most).value_or(1);
        const double turn = sky_->number("rotation", -360, 360).value_or(0) + north();
        light.map = std::make_shared<const RadianceMap>(read_environment_map(
            named_file(*sky_, "file", folder_, options_), turn, sky_->place("file"), options_));
    }

    // Fills the model; returns the horizontal irradiance to expect of it.
    double read_model(DistantLight& light, const std::string& model) {
        if (model == "uniform" || model == "overcast") {
            light.model = cie_sky(model == "uniform" ? 5 : 16);
            if (model == "uniform") light.model.c = light.model.e = 0;
            return in_units(sky_illuminance(overcast_day, altitude_.value_or(45 * degree)));
        }
        if (model == "clear" || model == "cie") {
            int type = 12;
            if (model == "cie") {
                sky_->require("type");
                type = static_cast<int>(*sky_->count("type", 1, 15));
            }
            light.model = cie_sky(type);
            const bool sunless = type == 1 || type == 3 || type == 5;
            if (!to_sun_ && !sunless) demand_sun(*sky_, "this sky");
            if (to_sun_) light.model.sun = *to_sun_;
            day_kind_ = type >= 11 ? clear_day : type >= 6 ? partly_cloudy_day : overcast_day;
            return in_units(sky_illuminance(day_kind_, altitude_.value_or(45 * degree)));
        }
        if (model != "perez") sky_->refuse("model", "overcast, clear, cie, perez, uniform or map");
        for (const char* key : {"direct_normal", "diffuse_horizontal"}) sky_->require(key);
        if (!to_sun_) demand_sun(*sky_, "this sky");
        if (!(*altitude_ > 0.5 * degree))
            throw Error(sky_->place("model"),
                        "found the sun below half a degree, where this model "
                        "has no meaning");
        light.model = read_perez(light);
        return perez_diffuse_;
    }

    SkyModel read_perez(const DistantLight&) {
        const MeasuredDaylight measured{*sky_->number("direct_normal", 0, 2000),
                                        *sky_->number("diffuse_horizontal", 0.1, 2000)};
        const SkyConditions conditions = sky_conditions(measured, *altitude_, day_);
        const DaylightEfficacy efficacy = daylight_efficacy(conditions, *altitude_);
        const bool watts = scene_.quantity == Quantity::radiometric;
        perez_diffuse_ = measured.diffuse_horizontal * (watts ? 1 : efficacy.diffuse);
        perez_direct_ = measured.direct_normal * (watts ? 1 : efficacy.direct);
        if (!sun_) add_sun(*perez_direct_, {}, sky_->place());
        SkyModel model = perez_sky(conditions, *altitude_);
        model.sun = *to_sun_;
        return model;
    }

    // Scales the sky to what is asked for, or expected.
    void set_level(DistantLight& light, double expected) {
        if (sky_->has("zenith_luminance") && sky_->has("horizontal"))
            throw Error(sky_->place("horizontal"),
                        "found both 'zenith_luminance' and 'horizontal', expected one of them");
        if (const auto zenith = sky_->number("zenith_luminance", 0, most)) {
            const double unit = light.model.luminance({0, 1, 0});
            light.model.scale = unit > 0 ? *zenith / unit : 0;
        } else {
            const double wanted = sky_->number("horizontal", 0, most).value_or(expected);
            const double unit = horizontal_irradiance(light);
            light.model.scale = unit > 0 ? wanted / unit : 0;
        }
        // The ground as a Lambertian plane under this sky: L = ρ E / π.
        light.ground = sky_->number("ground_reflectance", 0, 1).value_or(0) *
                       horizontal_irradiance(light) / std::numbers::pi;
    }

    void read_sun() {
        if (!to_sun_) demand_sun(*sun_, "[sun]");
        const double expected = in_units(
            sun_illuminance(day_kind_.extinction > 0 ? day_kind_ : clear_day, *altitude_, day_));
        // What is behind a uniform or overcast sky does not shine unless asked to.
        const bool hidden =
            sky_ && day_kind_.extinction == 0 && !perez_direct_ && *sky_->text("model") != "map";
        const double level =
            sun_->number("normal", 0, most).value_or(perez_direct_.value_or(hidden ? 0 : expected));
        add_sun(level * lamp_factor(*sun_), sun_, sun_->place());
    }

    void add_sun(double level, const std::optional<TomlTable>& table, const Place& place) {
        DistantLight light;
        light.name = table ? table->text("name").value_or("sun") : "sun";
        light.group = table ? table->text("group").value_or(light.name) : light.name;
        light.place = place;
        light.direction = *to_sun_;
        light.diameter = (table ? table->number("diameter", 0, 90).value_or(0.53) : 0.53) * degree;
        light.irradiance = to_sun_->y > 0 || (table && table->has("direction")) ? level : 0;
        if (table) light.colour = lamp_colour(*table);
        scene_.distant.push_back(std::move(light));
    }

    Scene& scene_;
    std::filesystem::path folder_;
    const ReadOptions& options_;
    std::optional<TomlTable> site_, sky_, sun_;
    std::optional<Vec3> to_sun_;
    std::optional<double> altitude_;
    int day_ = 81;  // of the equinox
    Availability day_kind_ = overcast_day;
    std::optional<double> perez_direct_;
    double perez_diffuse_ = 0;
};

}  // namespace

void add_daylight(Scene& scene, const TomlTable& project, const std::filesystem::path& folder,
                  const ReadOptions& options) {
    DaylightReader(scene, project, folder, options).read();
}

}  // namespace exitance
