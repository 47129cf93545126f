// SPDX-License-Identifier: Apache-2.0
// Pictures: .hdr and .exr as environment maps, PNG and JPEG as textures.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "exitance/run/error.h"
#include "exitance/scene/formats/contained_call.h"
#include "exitance/scene/formats/image_file.h"
#include "exitance/scene/formats/panorama_file.h"

namespace {

using namespace exitance;

// What a reader of textures does with them; std::runtime_error is how it is told of bad ones.
void read_texture(std::string_view bytes, const ReadOptions& options) {
    try {
        const ImageSizeInFile size = image_size(bytes);
        if (size.width * size.height > options.max_texture_pixels) return;
        const Texture texture(decode_image(bytes), {}, 1);
        const Vec3 mean = texture.mean();
        for (std::size_t c = 0; c < 3; ++c)
            if (!(mean[c] >= 0 && mean[c] <= 1)) std::abort();
    } catch (const Error&) {
        std::abort();
    } catch (const std::runtime_error&) {
    }
}

void use(const Panorama& sky) {
    if (sky.pixels.size() != 3 * sky.width * sky.height) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    ReadOptions options;  // small, that small files cannot ask for much work
    options.max_texture_pixels = 100'000;
    if (bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8")) {
        read_texture(bytes, options);
        return 0;
    }
    try {
        if (bytes.starts_with("#?"))
            use(decode_hdr(bytes, options));
        else  // as it is read for people
            contained_call(
                [&] {
                    use(decode_exr(bytes, options));
                    return std::string("read");
                },
                {std::size_t{1} << 30, 2});
    } catch (const std::runtime_error&) {
    }
    return 0;
}
