// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/environment_map.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <numbers>

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int widest = 16384, highest = 8192;
constexpr std::uint32_t map_level = 7;  // 1.1° a cell

struct Panorama {
    std::size_t width = 0, height = 0;
    std::vector<float> pixels;  ///< rows from the top, three bands
    const float* at(std::size_t x, std::size_t y) const { return &pixels[3 * (y * width + x)]; }
};

void check_size(long width, long height, const Place& named) {
    if (width < 2 || height < 1 || width > widest || height > highest)
        throw Error(
            named, fmt::format("found a picture of {} × {} pixels, expected at most {} × {}", width,
                               height, widest, highest));
}

Panorama read_hdr(const std::filesystem::path& path, const Place& named) {
    int width = 0, height = 0, channels = 0;
    if (!stbi_is_hdr(path.c_str()) || !stbi_info(path.c_str(), &width, &height, &channels))
        throw Error(named, path.string() + " is not a Radiance picture (.hdr)");
    check_size(width, height, named);
    const std::unique_ptr<float, void (*)(void*)> data(
        stbi_loadf(path.c_str(), &width, &height, &channels, 3), stbi_image_free);
    if (!data)
        throw Error(named,
                    fmt::format("{} cannot be read: {}", path.string(), stbi_failure_reason()));
    Panorama out{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
    out.pixels.assign(data.get(), data.get() + 3 * out.width * out.height);
    return out;
}

Panorama read_exr(const std::filesystem::path& path, const Place& named) {
    try {
        Imf::InputFile file(path.c_str());
        const auto box = file.header().dataWindow();
        const long width = long{box.max.x} - box.min.x + 1,
                   height = long{box.max.y} - box.min.y + 1;
        check_size(width, height, named);
        const bool grey = !file.header().channels().findChannel("R");
        const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
        std::vector<float> planes(3 * w * h, 0.0f);
        Imf::FrameBuffer frame;
        const char* const names[3] = {"R", "G", "B"};
        for (std::size_t c = 0; c < (grey ? 1u : 3u); ++c)
            frame.insert(grey ? "Y" : names[c],
                         Imf::Slice::Make(Imf::FLOAT, &planes[c * w * h], box, sizeof(float),
                                          w * sizeof(float)));
        file.setFrameBuffer(frame);
        file.readPixels(box.min.y, box.max.y);
        Panorama out{w, h, std::vector<float>(3 * w * h)};
        for (std::size_t i = 0; i < w * h; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                out.pixels[3 * i + c] = planes[(grey ? 0 : c * w * h) + i];
        return out;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(named, fmt::format("{} cannot be read: {}", path.string(), error.what()));
    }
}

}  // namespace

RadianceMap read_environment_map(const std::filesystem::path& path, double rotation,
                                 const Place& named) {
    const std::string kind = path.extension().string();
    if (kind != ".hdr" && kind != ".exr")
        throw Error(named, fmt::format("found '{}', expected a picture (.hdr or .exr)", kind));
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throw Error(named, fmt::format("there is no file {}", path.string()));
    const Panorama picture = kind == ".hdr" ? read_hdr(path, named) : read_exr(path, named);
    for (const float value : picture.pixels)
        if (!(value >= 0 && value <= 1e30f))
            throw Error(named, path.string() + " has values that are negative or no numbers");

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

}  // namespace exitance
