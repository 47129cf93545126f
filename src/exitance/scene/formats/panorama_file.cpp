// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/panorama_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

namespace exitance {

namespace {

[[noreturn]] void refuse(const std::string& why) {
    throw std::runtime_error(why);
}

// Before anything of that size is allocated. `densest`: pixels that a byte can hold.
void check_size(std::int64_t width, std::int64_t height, std::uint64_t densest,
                std::string_view bytes, const ReadOptions& options) {
    const std::string size = fmt::format("{} × {} pixels", width, height);
    // Equirectangular pictures are 2 : 1; others would be taken for what they are not.
    if (width < 2 || height < 1 || width < height || width > 4 * height)
        refuse("found " + size + ", expected about twice as wide as high");
    const auto w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
    if (h > options.max_texture_pixels / w)
        refuse(fmt::format("{}, more than {}; --max-texture-pixels raises the limit", size,
                           options.max_texture_pixels));
    if (w * h / densest > bytes.size())
        refuse(fmt::format("says that it has {}, but has only {} bytes", size, bytes.size()));
}

Panorama checked(Panorama panorama) {
    for (const float value : panorama.pixels)
        if (!(value >= 0 && value <= 1e30f)) refuse("has values that are negative or no numbers");
    return panorama;
}

// Radiance's run lengths: two bytes for up to 127 values of one of four bytes of a pixel.
constexpr std::uint64_t densest_hdr = 16;
// Blocks of 64 pixels may share a value, and deflate makes at most 1032 bytes of one.
constexpr std::uint64_t densest_exr = 64 * 1032;
constexpr std::size_t lines_at_once = 256;  // of the largest compressed block

// Where the pixels of a Radiance picture begin: after the empty line and the line of its size.
std::size_t begin_of_pixels(std::string_view bytes) {
    const std::size_t empty = bytes.find("\n\n");
    const std::size_t end = empty == bytes.npos ? empty : bytes.find('\n', empty + 2);
    if (end == bytes.npos || bytes.substr(0, end).find('\0') != bytes.npos)
        refuse("is not a Radiance picture (.hdr)");
    return end + 1;
}

// Runs fill their lines (Ward 1991, "Real Pixels", Graphics Gems II). stb_image waits for ever for
// a run of no length to do so, such as it reads behind the end of a file.
void check_runs(std::string_view bytes, std::size_t width, std::size_t height) {
    std::size_t at = begin_of_pixels(bytes);
    const auto check_pixels = [&] {
        if (4 * width * height > bytes.size() - at) refuse("ends too early");
    };
    if (width < 8 || width >= 32768) return check_pixels();
    const auto next = [&] {
        if (at >= bytes.size()) refuse("ends too early");
        return static_cast<unsigned char>(bytes[at++]);
    };
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t begin = at;
        const unsigned first = next(), second = next(), high = next();
        if (first != 2 || second != 2 || high >= 128) {  // pixel by pixel
            if (y > 0) refuse("has a line without runs below lines of runs");
            at = begin;
            return check_pixels();
        }
        next();
        for (int component = 0; component < 4; ++component)
            for (std::size_t filled = 0; filled < width;) {
                const std::size_t code = next(), count = code > 128 ? code - 128 : code;
                if (count == 0 || count > width - filled) refuse("has a run that cannot be");
                filled += count;
                at += code > 128 ? 1 : count;
            }
    }
}

// OpenEXR's way to bytes in memory.
class ExrBytes : public Imf::IStream {
  public:
    explicit ExrBytes(std::string_view bytes) : Imf::IStream("it"), bytes_(bytes) {}

    bool read(char to[], int count) override {
        const auto n = static_cast<std::uint64_t>(count);
        if (count < 0 || at_ > bytes_.size() || n > bytes_.size() - at_)
            throw std::runtime_error("it ends too early");
        std::memcpy(to, bytes_.data() + at_, n);
        at_ += n;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t to) override { at_ = to; }

  private:
    std::string_view bytes_;
    std::uint64_t at_ = 0;
};

}  // namespace

Panorama decode_hdr(std::string_view bytes, const ReadOptions& options) {
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    if (bytes.size() > std::numeric_limits<int>::max()) refuse("is larger than 2 GiB");
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_is_hdr_from_memory(data, size) ||
        !stbi_info_from_memory(data, size, &width, &height, &channels))
        refuse("is not a Radiance picture (.hdr)");
    check_size(width, height, densest_hdr, bytes, options);
    check_runs(bytes, static_cast<std::size_t>(width), static_cast<std::size_t>(height));
    const std::unique_ptr<float, void (*)(void*)> pixels(
        stbi_loadf_from_memory(data, size, &width, &height, &channels, 3), stbi_image_free);
    if (!pixels) refuse(fmt::format("cannot be read: {}", stbi_failure_reason()));
    Panorama out{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
    out.pixels.assign(pixels.get(), pixels.get() + 3 * out.width * out.height);
    return checked(std::move(out));
}

Panorama decode_exr(std::string_view bytes, const ReadOptions& options) {
    ExrBytes stream(bytes);
    Imf::InputFile file(stream, 1);
    const auto box = file.header().dataWindow();
    const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1,
                       height = std::int64_t{box.max.y} - box.min.y + 1;
    check_size(width, height, densest_exr, bytes, options);
    const bool grey = !file.header().channels().findChannel("R");
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    // A band of lines at a time, so that a file that ends early has not filled memory before.
    Panorama out{w, h, {}};
    std::vector<float> planes;
    const char* const names[3] = {"R", "G", "B"};
    for (std::size_t y = 0; y < h; y += lines_at_once) {
        const std::size_t lines = std::min(lines_at_once, h - y);
        planes.assign(3 * w * lines, 0.0f);
        const int first = box.min.y + static_cast<int>(y),
                  last = first + static_cast<int>(lines) - 1;
        const Imath::Box2i window({box.min.x, first}, {box.max.x, last});
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < (grey ? 1u : 3u); ++c)
            frame.insert(grey ? "Y" : names[c],
                         Imf::Slice::Make(Imf::FLOAT, &planes[c * w * lines], window, sizeof(float),
                                          w * sizeof(float)));
        file.setFrameBuffer(frame);
        file.readPixels(first, last);
        for (std::size_t i = 0; i < w * lines; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                out.pixels.push_back(planes[(grey ? 0 : c * w * lines) + i]);
    }
    return checked(std::move(out));
}

}  // namespace exitance
