// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/environment_map.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "exitance/scene/formats/contained_call.h"
#include "exitance/scene/formats/panorama_cells.h"
#include "exitance/scene/formats/panorama_file.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

std::string bytes_of(const RadianceMap& map) {
    return {reinterpret_cast<const char*>(map.cells.data()), map.cells.size() * sizeof(float)};
}

RadianceMap map_from(const std::string& bytes) {
    RadianceMap map;
    map.cells.resize(bytes.size() / sizeof(float));
    while (std::size_t{6} << (2 * map.level) < map.cells.size()) ++map.level;
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
    const std::string kind = lower_extension(path);
    if (kind != ".hdr" && kind != ".exr")
        throw Error(named, fmt::format("found '{}', expected a picture (.hdr or .exr)", kind));
    try {
        const std::string bytes = read_whole_file(path, options.most_bytes());
        if (kind == ".hdr") return cells_of(decode_hdr(bytes, options), rotation);
        return map_from(
            contained_call([&] { return bytes_of(cells_of(decode_exr(bytes, options), rotation)); },
                           limits_for(bytes.size(), options)));
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& why) {
        throw Error(named, fmt::format("{}: {}", path.string(), as_utf8(why.what())));
    }
}

}  // namespace exitance
