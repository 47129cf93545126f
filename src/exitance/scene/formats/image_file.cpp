// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/image_file.h"

#include <png.h>
#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

namespace exitance {

namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n", jpeg_signature = "\xff\xd8\xff";

bool starts_with(std::string_view bytes, std::string_view signature) {
    return bytes.substr(0, signature.size()) == signature;
}

class Png {
  public:
    explicit Png(std::string_view bytes) {
        image_.version = PNG_IMAGE_VERSION;
        if (!png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size())) fail();
    }
    ~Png() { png_image_free(&image_); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;

    ImageSizeInFile size() const { return {image_.width, image_.height}; }
    TexturePicture decode() {
        // Four channels: with three, what is transparent would be painted over.
        image_.format = PNG_FORMAT_RGBA;
        std::vector<std::uint8_t> rgba(std::size_t{4} * image_.width * image_.height);
        if (!png_image_finish_read(&image_, nullptr, rgba.data(), 0, nullptr)) fail();
        TexturePicture out{image_.width, image_.height, {}};
        out.rgb.reserve(rgba.size() / 4 * 3);
        for (std::size_t i = 0; i < rgba.size(); i += 4)
            out.rgb.insert(out.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
        return out;
    }

  private:
    [[noreturn]] void fail() const {
        throw std::runtime_error(std::string("not a sound PNG: ") + image_.message);
    }
    png_image image_{};
};

class Jpeg {
  public:
    explicit Jpeg(std::string_view bytes)
        : bytes_(bytes), decoder_(tjInitDecompress(), [](void* handle) { tjDestroy(handle); }) {
        int subsampling = 0, colours = 0;
        if (!decoder_ ||
            tjDecompressHeader3(decoder_.get(), data(), bytes_.size(), &width_, &height_,
                                &subsampling, &colours) != 0 ||
            width_ < 1 || height_ < 1)
            fail();
    }

    ImageSizeInFile size() const {
        return {static_cast<std::uint64_t>(width_), static_cast<std::uint64_t>(height_)};
    }
    TexturePicture decode() const {
        TexturePicture out{
            static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_), {}};
        out.rgb.resize(std::size_t{3} * out.width * out.height);
        // Damaged data is a warning of the library and a wrong picture; here it is an error. Many
        // scans of one picture are how small files take hours.
        if (tjDecompress2(decoder_.get(), data(), bytes_.size(), out.rgb.data(), width_, 0, height_,
                          TJPF_RGB, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
            fail();
        return out;
    }

  private:
    const unsigned char* data() const {
        return reinterpret_cast<const unsigned char*>(bytes_.data());
    }
    [[noreturn]] void fail() const {
        throw std::runtime_error(std::string("not a sound JPEG: ") +
                                 tjGetErrorStr2(decoder_.get()));
    }
    std::string_view bytes_;
    std::unique_ptr<void, void (*)(void*)> decoder_;
    int width_ = 0, height_ = 0;
};

template <class Use>
auto with_decoder(std::string_view bytes, const Use& use) {
    if (starts_with(bytes, png_signature)) {
        Png png(bytes);
        return use(png);
    }
    if (starts_with(bytes, jpeg_signature)) {
        Jpeg jpeg(bytes);
        return use(jpeg);
    }
    throw std::runtime_error("neither a PNG nor a JPEG");
}

}  // namespace

ImageSizeInFile image_size(std::string_view bytes) {
    return with_decoder(bytes, [](auto& decoder) { return decoder.size(); });
}

TexturePicture decode_image(std::string_view bytes) {
    return with_decoder(bytes, [](auto& decoder) { return decoder.decode(); });
}

std::string encode_png(const TexturePicture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string out(size, '\0');
    if (!png_image_write_to_memory(&image, out.data(), &size, 0, picture.rgb.data(), 0, nullptr))
        throw std::runtime_error(std::string("cannot encode PNG: ") + image.message);
    out.resize(size);
    return out;
}

}  // namespace exitance
