// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/environment_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "exitance/scene/formats/contained_call.h"
#include "exitance/scene/formats/panorama_file.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t map_level = 7;  // 1.1° a cell

RadianceMap map_of(const Panorama& picture, double rotation) {
    RadianceMap map;
    map.level = map_level;
    const std::uint32_t n = map.side();
    std::vector<double> sum(std::size_t{6} * n * n), weight(std::size_t{2} * n * n);
    const auto turn = rotation * pi / 180;
    // Every pixel's light, by as many places of it as make it finer than the cells.
    const auto finer =
        static_cast<std::size_t>(std::clamp(std::ceil(8.0 * n / double(picture.width)), 1.0, 64.0));
    for (std::size_t y = 0; y < picture.height * finer; ++y) {
        const double zenith = pi * (double(y) + 0.5) / double(picture.height * finer);
        for (std::size_t x = 0; x < picture.width * finer; ++x) {
            // Columns go round clockwise seen from above: the right of −z is +x.
            const double round =
                2 * pi * ((double(x) + 0.5) / double(picture.width * finer) - 0.5) - turn;
            const DirectionPlace place =
                place_of({std::sin(zenith) * std::sin(round), std::cos(zenith),
                          -std::sin(zenith) * std::cos(round)});
            const auto column = std::min(n - 1, static_cast<std::uint32_t>(place.u * n));
            const auto row = std::min(n - 1, static_cast<std::uint32_t>(place.v * n));
            const std::size_t cell = (std::size_t{place.lower} * n + row) * n + column;
            const float* pixel = picture.at(x / finer, y / finer);
            weight[cell] += std::sin(zenith);
            for (std::size_t b = 0; b < 3; ++b)
                sum[3 * cell + b] += std::sin(zenith) * double(pixel[b]);
        }
    }
    map.cells.resize(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i)
        map.cells[i] = static_cast<float>(weight[i / 3] > 0 ? sum[i] / weight[i / 3] : 0);
    return map;
}

std::string bytes_of(const RadianceMap& map) {
    return {reinterpret_cast<const char*>(map.cells.data()), map.cells.size() * sizeof(float)};
}

RadianceMap map_from(const std::string& bytes) {
    RadianceMap map;
    map.level = map_level;
    map.cells.resize(bytes.size() / sizeof(float));
    std::memcpy(map.cells.data(), bytes.data(), bytes.size());
    return map;
}

// What the largest picture needs, and time as for one that is packed as tightly as can be.
CallLimits limits_for(std::size_t bytes, const ReadOptions& options) {
    return {(std::uint64_t{1} << 30) + 40 * options.max_texture_pixels, 10 + bytes / (1024 * 1024)};
}

}  // namespace

RadianceMap read_environment_map(const std::filesystem::path& path, double rotation,
                                 const Place& named, const ReadOptions& options) {
    const std::string kind = path.extension().string();
    if (kind != ".hdr" && kind != ".exr")
        throw Error(named, fmt::format("found '{}', expected a picture (.hdr or .exr)", kind));
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throw Error(named, fmt::format("there is no file {}", path.string()));
    try {
        const std::string bytes = read_whole_file(path, options.most_bytes());
        if (kind == ".hdr") return map_of(decode_hdr(bytes, options), rotation);
        return map_from(
            contained_call([&] { return bytes_of(map_of(decode_exr(bytes, options), rotation)); },
                           limits_for(bytes.size(), options)));
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& why) {
        throw Error(named, fmt::format("{}: {}", path.string(), as_utf8(why.what())));
    }
}

}  // namespace exitance
