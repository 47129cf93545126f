// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "exitance/render/camera_rays.h"
#include "exitance/render/false_colour.h"
#include "exitance/render/overlays.h"
#include "exitance/render/raycast.h"
#include "exitance/render/tone.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

/// The weight of each group: the solution's, or as asked for. Throws for unknown names.
std::vector<double> group_weights(const Solution& s, const RenderOptions& options) {
    std::vector<std::string> names;
    std::vector<double> weights;
    for (const LightGroup& group : s.groups) {
        names.push_back(group.name);
        weights.push_back(group.weight);
    }
    for (const auto& [name, weight] : options.group_weights) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw Error(Fault::wrong_use,
                        fmt::format("--group: the solution has no group '{}'{}; "
                                    "its groups are {}",
                                    name, suggestion(name, names), fmt::join(names, ", ")));
        weights[static_cast<std::size_t>(found - names.begin())] = weight;
    }
    return weights;
}

/// Irradiance and emission with the light groups summed: one row of three values per vertex and
/// per part.
class WeightedLight {
  public:
    WeightedLight(const Surfaces& surfaces, const RenderOptions& options) : surfaces_(surfaces) {
        const Solution& s = surfaces.solution();
        const std::vector<double> weights = group_weights(s, options);
        bands_ = s.bands.size();
        H_.resize(s.positions.size() * bands_);
        parallel_for(s.positions.size(), [&](std::size_t v) {
            const auto row = s.irradiance[VertexId(v)];
            for (std::size_t b = 0; b < bands_; ++b) {
                double sum = 0;
                for (std::size_t g = 0; g < weights.size(); ++g)
                    sum += weights[g] * double(row[g * bands_ + b]);
                H_[v * bands_ + b] = static_cast<float>(sum);
            }
        });
        for (const SolutionPart& part : s.parts) weight_of_emission_.push_back(weights[part.group]);
        luminance_ = luminance_weights(bands_);
    }

    double irradiance(const SurfacePlace& place, std::size_t band) const {
        const auto& corners = surfaces_.solution().triangles[place.triangle];
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k)
            sum += place.weights[k] * double(H_[corners[k] * bands_ + band]);
        return sum;
    }

    /// Calls `take(band, B)` for B = E + ρ H of each band, E and ρ as their patterns are there.
    template <class Take>
    void exitance(const SurfacePlace& place, const Take& take) const {
        const Solution& s = surfaces_.solution();
        const auto index =
            static_cast<std::size_t>(&surfaces_.part(place.triangle) - s.parts.data());
        Surfaces::PatternHere room_of_rho, room_of_E;
        const auto rho = surfaces_.reflectance(place, room_of_rho);
        const auto E = surfaces_.emission(place, room_of_E);
        for (std::size_t b = 0; b < bands_; ++b)
            take(b, weight_of_emission_[index] * E[b] + rho[b] * irradiance(place, b));
    }

    /// Radiance of a diffuse surface, L = B / π.
    Vec3f radiance(const SurfacePlace& place) const {
        constexpr double over_pi = 1 / std::numbers::pi;
        if (bands_ == 3) {
            Vec3 rgb;
            exitance(place, [&](std::size_t b, double B) { rgb[b] = B; });
            return Vec3f(rgb * over_pi);
        }
        const auto grey = static_cast<float>(over_pi * total_exitance(place));
        return {grey, grey, grey};
    }

    double total_exitance(const SurfacePlace& place) const {
        double sum = 0;
        exitance(place, [&](std::size_t b, double B) { sum += luminance_[b] * B; });
        return sum;
    }
    double total_irradiance(const SurfacePlace& place) const {
        double sum = 0;
        for (std::size_t b = 0; b < bands_; ++b) sum += luminance_[b] * irradiance(place, b);
        return sum;
    }

  private:
    const Surfaces& surfaces_;
    std::size_t bands_ = 0;
    std::vector<float> H_;                    // vertices × bands
    std::vector<double> weight_of_emission_;  // per part
    Spectrum luminance_;
};

/// The sky behind everything, with the weights of the light groups; nothing if there is none. Suns
/// are not drawn.
std::function<Vec3f(const Vec3&)> sky_behind(const Surfaces& surfaces,
                                             const RenderOptions& options) {
    const Solution& s = surfaces.solution();
    struct WeightedSky {
        const DistantLight* light;
        double weight;
    };
    std::vector<WeightedSky> skies;
    const std::vector<double> weights = group_weights(s, options);
    for (const SolutionDistantLight& placed : s.distant)
        if (placed.light.kind == DistantLight::Kind::sky)
            skies.push_back({&placed.light, weights[placed.group]});
    if (skies.empty()) return {};
    return [skies](const Vec3& way) {
        const Vec3 direction = normalized(way);
        Vec3 sum;
        for (const WeightedSky& sky : skies) {
            const Spectrum L = sky.light->radiance(direction);
            const double grey = luminance(L);
            sum += (L.size() == 3 ? Vec3{L[0], L[1], L[2]} : Vec3{grey, grey, grey}) * sky.weight;
        }
        return Vec3f(sum);
    };
}

/// Up to the value that 99 % of what is seen stays below, rounded up to two digits.
std::array<double, 2> automatic_range(const Raycast& values) {
    std::vector<float> seen;
    for (std::size_t i = 0; i < values.coverage.size(); ++i)
        if (values.coverage[i] > 0.5f)
            seen.push_back(values.image.pixels[i].x / values.coverage[i]);
    if (seen.empty()) return {0, 1};
    const auto high = seen.begin() + std::ptrdiff_t(seen.size() * 99 / 100);
    std::nth_element(seen.begin(), high, seen.end());
    if (!(*high > 0)) return {0, 1};
    const double unit = std::pow(10, std::floor(std::log10(double(*high))) - 1);
    return {0, std::ceil(double(*high) / unit * (1 - 1e-6)) * unit};
}

/// Each ray is tone mapped before the pixel's mean is taken: a lamp's edge then falls as smoothly
/// on the screen as any other.
Image tone_mapped(const Surfaces& surfaces, const CameraRays& camera, ImageSize size,
                  const RenderOptions& options) {
    const WeightedLight light(surfaces, options);
    const auto samples = static_cast<std::uint32_t>(options.samples);
    const auto radiance = [&](const ViewHit& hit) { return light.radiance(hit.place); };
    constexpr std::uint32_t metering_samples = 2;
    const Raycast metered = raycast(surfaces, camera, size.width, size.height,
                                    std::min(samples, metering_samples), options.seed, radiance);
    const double exposure = options.ev ? exposure_of_ev(*options.ev)
                                       : automatic_exposure(metered.image, metered.coverage);
    const double white = white_of(metered.image, exposure);
    const ToneCurve curve = tone_curve(options.tone);
    const auto tone = [&](const Vec3f& seen) {
        return toned(seen * static_cast<float>(exposure), curve, white);
    };
    std::function<Vec3f(const Vec3&)> sky = sky_behind(surfaces, options);
    if (sky) sky = [&tone, sky](const Vec3& way) { return tone(sky(way)); };
    return raycast(
               surfaces, camera, size.width, size.height, samples, options.seed,
               [&](const ViewHit& hit) { return tone(radiance(hit)); }, sky)
        .image;
}

struct FalseColours {
    Image image;
    std::array<double, 2> range;
};

FalseColours in_false_colours(const Surfaces& surfaces, const CameraRays& camera, ImageSize size,
                              const RenderOptions& options) {
    const WeightedLight light(surfaces, options);
    const bool irradiance = *options.false_colour == "irradiance";
    const Raycast values =
        raycast(surfaces, camera, size.width, size.height,
                static_cast<std::uint32_t>(options.samples), options.seed, [&](const ViewHit& hit) {
                    const double value = irradiance ? light.total_irradiance(hit.place)
                                                    : light.total_exitance(hit.place);
                    return Vec3f{static_cast<float>(value), 0, 0};
                });
    const auto [low, high] = options.range.value_or(automatic_range(values));
    if (!(std::isfinite(low) && std::isfinite(high) && low < high))
        throw Error(Fault::wrong_use,
                    fmt::format("--range: {:g} {:g} is not allowed, expected the lower end first",
                                low, high));
    FalseColours out{Image(size.width, size.height), {low, high}};
    parallel_for(out.image.pixels.size(), [&, low = low, high = high](std::size_t i) {
        const float coverage = values.coverage[i];
        if (!(coverage > 0)) return;
        const double value = double(values.image.pixels[i].x / coverage);
        out.image.pixels[i] = false_colour((value - low) / (high - low)) * coverage;
    });
    return out;
}

void add_legend(Image& image, Quantity quantity, bool irradiance,
                const std::array<double, 2>& range) {
    const char* title = !irradiance                         ? "exitance"
                        : quantity == Quantity::photometric ? "illuminance"
                                                            : "irradiance";
    draw_legend(image, range[0], range[1], title,
                irradiance ? irradiance_unit(quantity) : exitance_unit(quantity));
}

}  // namespace

Image render_radiance(const Surfaces& surfaces, const Camera& camera, ImageSize size,
                      const RenderOptions& options) {
    const CameraRays rays(camera, size.width, size.height);
    const WeightedLight light(surfaces, options);
    return raycast(
               surfaces, rays, size.width, size.height, static_cast<std::uint32_t>(options.samples),
               options.seed, [&](const ViewHit& hit) { return light.radiance(hit.place); },
               sky_behind(surfaces, options))
        .image;
}

Image render_display(const Surfaces& surfaces, const Camera& camera, ImageSize size,
                     const RenderOptions& options) {
    const CameraRays rays(camera, size.width, size.height);
    Image image;
    std::array<double, 2> range{};
    if (options.false_colour) {
        FalseColours colours = in_false_colours(surfaces, rays, size, options);
        image = std::move(colours.image);
        range = colours.range;
    } else {
        image = tone_mapped(surfaces, rays, size, options);
    }
    if (options.wireframe)
        draw_wireframe(image, surfaces, rays, static_cast<std::uint32_t>(options.samples),
                       options.seed);
    if (options.normals) draw_normals(image, surfaces, rays);
    if (options.false_colour)
        add_legend(image, surfaces.solution().quantity, *options.false_colour == "irradiance",
                   range);
    return image;
}

ImageSize size_of_picture(const RenderOptions& options, const Camera& camera) {
    if (options.size) return parse_size(*options.size);
    const double aspect = camera.aspect.value_or(4.0 / 3.0);
    return {static_cast<std::uint32_t>(std::clamp(std::round(768 * aspect), 1.0, 16384.0)), 768};
}

}  // namespace exitance
