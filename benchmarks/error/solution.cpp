// SPDX-License-Identifier: Apache-2.0
// How wrong solutions are, by brute force: one JSON object on stdout.
//
//     error_solution SCENE PLACES PATHS TRUTH.csv [SOLUTION.glb]...
//
// Irradiance that is read off their surfaces is compared with path-traced irradiance at the same
// places (places.h), PATHS (a multiple of 16) each, which is kept in TRUTH.csv, as it takes
// minutes. Errors are root mean squares over the places, of colours as vectors, as a share of the
// mean; the truth's own noise, known from its replicates, is subtracted from their squares.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "error/places.h"
#include "exitance/run/atomic_file.h"
#include "exitance/run/error.h"
#include "exitance/scene/read.h"
#include "exitance/solution/file.h"
#include "exitance/solution/surface_probe.h"
#include "measured_solve.h"

namespace exitance::benchmarks {
namespace {

constexpr std::uint32_t replicates = 16;

/// Rows: places; columns: bands. `mean` of the one and of the other, and what it cost.
struct Truth {
    std::vector<double> mean, noise;
    double cpu_seconds = 0;
};

Truth trace(const Scene& scene, std::span<const Place> places, std::uint32_t paths) {
    std::vector<truth::Receiver> receivers;
    for (const Place& place : places) receivers.push_back(place.receiver);
    const double before = cpu_seconds();
    const truth::Estimate found =
        truth::PathTracer(scene).irradiance(receivers, {paths / replicates, replicates, 3});
    return {found.mean, found.standard_error, cpu_seconds() - before};
}

void write(const Truth& truth, const std::filesystem::path& path) {
    write_atomically(path, [&](std::ostream& out) {
        out << fmt::format("{:.6g}\n", truth.cpu_seconds);
        for (std::size_t i = 0; i < truth.mean.size(); ++i)
            out << fmt::format("{:.6g},{:.3g}\n", truth.mean[i], truth.noise[i]);
    });
}

Truth read(const std::filesystem::path& path, std::size_t values) {
    std::ifstream in(path);
    Truth truth;
    in >> truth.cpu_seconds;
    double mean = 0, noise = 0;
    for (char comma = 0; in >> mean >> comma >> noise;) {
        truth.mean.push_back(mean);
        truth.noise.push_back(noise);
    }
    if (truth.mean.size() != values)
        throw Error(Fault::bad_input, fmt::format("{}: found {} values, expected {} of these "
                                                  "places; remove it to trace them anew",
                                                  path.string(), truth.mean.size(), values));
    return truth;
}

/// Σ error² − noise², and what it is compared with.
struct Sum {
    double square = 0, noise = 0, light = 0, relative = 0;
    std::size_t count = 0;
};

/// The same of luminance, which is what solutions estimate; bands of one path are noisy together.
class LuminanceError {
  public:
    void add(double here, double there, double noise) {
        squares_.push_back(std::pow(here - there, 2) - noise * noise);
        light_ += there;
    }
    /// RMS relative to the mean, and its standard error.
    std::array<double, 2> rms() const {
        const double n = double(squares_.size()), level = light_ / n;
        double mean = 0, spread = 0;
        for (const double s : squares_) mean += s / n;
        for (const double s : squares_) spread += std::pow(s - mean, 2);
        const double rms = std::sqrt(std::max(0.0, mean));
        const double deviation = std::sqrt(spread) / n;  // d√x = dx / 2√x
        return {rms / level, (rms > 0 ? deviation / (2 * rms) : std::sqrt(deviation)) / level};
    }

  private:
    std::vector<double> squares_;
    double light_ = 0;
};

nlohmann::ordered_json compare(const std::string& path, std::span<const Place> places,
                               const Truth& truth, std::size_t bands) {
    const Solution solution = read_solution(path);
    const Surfaces surfaces(solution, Backs::black);
    std::vector<double> found(solution.columns());
    std::vector<double> mean(bands, 0.0);
    const Spectrum weight = luminance_weights(bands);
    Sum all, contact;
    LuminanceError of_luminance;
    std::size_t missed = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const truth::Receiver& at = places[i].receiver;
        if (!probe_surface(surfaces, at.position, at.normal, found)) {
            ++missed;
            continue;
        }
        double square = 0, noise = 0, light = 0, level_here = 0, level_there = 0, level_noise = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            double here = 0;
            for (std::size_t g = 0; g < solution.groups.size(); ++g)
                here += solution.groups[g].weight * found[g * bands + b];
            const double there = truth.mean[i * bands + b];
            square += std::pow(here - there, 2);
            noise += std::pow(truth.noise[i * bands + b], 2);
            light += there * there;
            mean[b] += there;
            level_here += weight[b] * here, level_there += weight[b] * there;
            level_noise += weight[b] * truth.noise[i * bands + b];
        }
        of_luminance.add(level_here, level_there, level_noise);
        for (Sum* sum : {&all, &contact}) {
            if (sum == &contact && !places[i].contact) continue;
            sum->square += square, sum->noise += noise, sum->light += std::sqrt(light);
            sum->relative += light > 0 ? (square - noise) / light : 0.0;
            ++sum->count;
        }
    }
    double level = 0;
    for (const double m : mean) level += m * m;
    const double n = double(all.count);
    level = std::sqrt(level) / n;
    nlohmann::ordered_json out{
        {"solution", path},
        {"places", all.count},
        {"missed", missed},
        {"error", std::sqrt(std::max(0.0, (all.square - all.noise) / n)) / level},
        {"noise", std::sqrt(all.noise / n) / level},
        {"of_luminance", of_luminance.rms()}};
    if (contact.count)
        out["contacts"] = {
            {"texels", contact.count},
            {"of_local", std::sqrt(std::max(0.0, contact.relative / double(contact.count)))}};
    if (solution.error) out["estimate"] = {solution.error->rms, solution.error->confidence};
    out["counters"] = solution.counters;
    return out;
}

nlohmann::ordered_json report(int argc, char** argv) {
    if (argc < 5)
        throw Error(Fault::wrong_use, "expected SCENE PLACES PATHS TRUTH.csv [SOLUTION.glb]...");
    const Scene scene = read_scene(argv[1]);
    const std::vector<Place> places = find_places(scene, argv[2]);
    const auto paths = static_cast<std::uint32_t>(std::stoul(argv[3]));
    const std::filesystem::path kept = argv[4];
    const std::size_t bands = scene.bands.size();
    if (!exists(kept)) write(trace(scene, places, paths), kept);
    const Truth truth = read(kept, places.size() * bands);
    nlohmann::ordered_json out{{"scene", argv[1]},
                               {"polygons", scene.polygons.size()},
                               {"paths", paths},
                               {"path_cpu_seconds", truth.cpu_seconds},
                               {"solutions", nlohmann::ordered_json::array()}};
    for (int i = 5; i < argc; ++i)
        out["solutions"].push_back(compare(argv[i], places, truth, bands));
    return out;
}

}  // namespace
}  // namespace exitance::benchmarks

int main(int argc, char** argv) {
    try {
        std::puts(exitance::benchmarks::report(argc, argv).dump().c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
