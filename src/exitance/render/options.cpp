// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/options.h"

#include <charconv>

#include "exitance/run/error.h"

namespace exitance {

Options describe(RenderOptions& o) {
    return {
        {"size", &o.size,
         "width and height, as 1280x720; default: 768 high, as wide as the camera "
         "says, else 4:3",
         "pixels"},
        {"samples", &o.samples, "rays per pixel; more make edges smoother", "", 1, 4096},
        {"tone",
         &o.tone,
         "how light becomes display values: linear clips; reinhard keeps highlights; filmic adds "
         "contrast",
         "",
         0,
         0,
         {"linear", "reinhard", "filmic"}},
        {"ev", &o.ev,
         "exposure: luminance 1.2 · 2^EV becomes white before the tone curve; "
         "default: from the picture's average",
         "EV", -40, 40},
        {"false-colour",
         &o.false_colour,
         "show this quantity as colours with a legend (PNG only)",
         "",
         0,
         0,
         {"irradiance", "exitance"}},
        {"wireframe", &o.wireframe, "draw the edges of the mesh (PNG only)"},
        {"normals", &o.normals, "draw the normals of the mesh's vertices (PNG only)"},
        {"seed", &o.seed, "seed of the sample positions; same seed, same bytes"},
    };
}

ImageSize parse_size(const std::string& text) {
    ImageSize size{};
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, size.width);
    if (first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x') {
        const auto second = std::from_chars(first.ptr + 1, end, size.height);
        const bool sound = second.ec == std::errc{} && second.ptr == end;
        if (sound && size.width >= 1 && size.width <= 16384 && size.height >= 1 &&
            size.height <= 16384)
            return size;
    }
    throw Error(Fault::wrong_use,
                "--size: '" + text + "' is not allowed, expected WIDTHxHEIGHT, each 1 … 16384");
}

}  // namespace exitance
