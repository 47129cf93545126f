// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/image.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <png.h>
#include <stb/stb_image_write.h>

#include <cmath>
#include <cstring>
#include <string>

#include "exitance/run/atomic_file.h"
#include "exitance/run/error.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

[[noreturn]] void cannot_encode(const char* format, const std::string& why) {
    throw Error(Fault::could_not_finish, std::string("cannot encode ") + format + ": " + why);
}

std::string encode_png(const Image& image) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * image.pixels.size());
    for (const Vec3f& pixel : image.pixels)
        for (std::size_t i = 0; i < 3; ++i)
            bytes.push_back(
                static_cast<std::uint8_t>(std::lround(255.0f * srgb_encoded(pixel[i]))));
    png_image description{};
    description.version = PNG_IMAGE_VERSION;
    description.width = image.width;
    description.height = image.height;
    description.format = PNG_FORMAT_RGB;
    std::string out;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
    out.resize(size);
    if (!png_image_write_to_memory(&description, out.data(), &size, 0, bytes.data(), 0, nullptr))
        cannot_encode("PNG", description.message);
    out.resize(size);
    return out;
}

/// OpenEXR goes back to fill in its table of offsets; memory lets it.
class MemoryStream : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char* bytes, int n) override {
        const auto count = static_cast<std::size_t>(n);
        if (position_ + count > data.size()) data.resize(position_ + count);
        std::memcpy(data.data() + position_, bytes, count);
        position_ += count;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string data;

  private:
    std::size_t position_ = 0;
};

std::string encode_exr(const Image& image) {
    try {
        Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        std::vector<Vec3f> pixels = image.pixels;  // OpenEXR takes them as mutable
        const char* names[] = {"R", "G", "B"};
        for (std::size_t i = 0; i < 3; ++i) {
            header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
            frame.insert(names[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&pixels[0][i]),
                                              sizeof(Vec3f), sizeof(Vec3f) * image.width));
        }
        MemoryStream stream;
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(frame);
            file.writePixels(static_cast<int>(image.height));
        }
        return std::move(stream.data);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        cannot_encode("OpenEXR", error.what());
    }
}

std::string encode_hdr(const Image& image) {
    std::string out;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                              static_cast<std::size_t>(size));
    };
    if (!stbi_write_hdr_to_func(append, &out, static_cast<int>(image.width),
                                static_cast<int>(image.height), 3, &image.pixels[0].x))
        cannot_encode("HDR", "the encoder gave up");
    return out;
}

}  // namespace

ImageFormat image_format(const std::filesystem::path& path) {
    const std::string ending = lower_extension(path);
    if (ending == ".png") return ImageFormat::png;
    if (ending == ".exr") return ImageFormat::exr;
    if (ending == ".hdr") return ImageFormat::hdr;
    throw Error(Fault::wrong_use, "'" + path.string() +
                                      "' is not allowed for an image, expected a name that ends "
                                      "in .png, .exr or .hdr");
}

float srgb_encoded(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

void write_image(const Image& image, const std::filesystem::path& path) {
    const ImageFormat format = image_format(path);
    const std::string bytes = format == ImageFormat::png   ? encode_png(image)
                              : format == ImageFormat::exr ? encode_exr(image)
                                                           : encode_hdr(image);
    write_atomically(path, [&](std::ostream& out) {
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    });
}

}  // namespace exitance
