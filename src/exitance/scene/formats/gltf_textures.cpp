// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_textures.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/image_file.h"

namespace exitance {

namespace {

// Codes of OpenGL, as samplers give them (glTF 2.0, section 5.26).
constexpr std::size_t nearest_filter = 9728, clamp_to_edge = 33071, mirrored_repeat = 33648;

TextureWrap wrap_of(const JsonNode& sampler, const std::string& key) {
    const JsonNode code = sampler.member(key);
    if (!code) return TextureWrap::repeat;
    const std::size_t wrap = code.whole(0, 65535, "a wrap mode");
    return wrap == clamp_to_edge     ? TextureWrap::clamp
           : wrap == mirrored_repeat ? TextureWrap::mirror
                                     : TextureWrap::repeat;
}

/// What a file may not hold, as against what it holds damaged.
struct TooManyPixels {
    std::string what;
};

double number(const tinygltf::Value& object, const char* key, double otherwise) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : otherwise;
}

std::array<double, 2> pair(const tinygltf::Value& object, const char* key, double otherwise) {
    if (!object.Has(key)) return {otherwise, otherwise};
    const tinygltf::Value& value = object.Get(key);
    return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

}  // namespace

TexturePoint GltfTextureUse::operator()(double u, double v) const {
    return {static_cast<float>(transform[0] * u + transform[1] * v + transform[2]),
            static_cast<float>(transform[3] * u + transform[4] * v + transform[5])};
}

GltfTextures::GltfTextures(const GltfResources& resources, const JsonText& json,
                           const ReadOptions& options, Warn warn)
    : resources_(resources), json_(json), options_(options), warn_(std::move(warn)) {}

GltfTextureUse GltfTextures::use(const tinygltf::TextureInfo& info, double most,
                                 const std::string& path) {
    GltfTextureUse out;
    if (info.index < 0) return out;
    out.set = info.texCoord;
    const auto extension = info.extensions.find("KHR_texture_transform");
    if (extension != info.extensions.end()) {
        const tinygltf::Value& t = extension->second;
        const auto [x, y] = pair(t, "offset", 0);
        const auto [sx, sy] = pair(t, "scale", 1);
        const double turn = number(t, "rotation", 0), c = std::cos(turn), s = std::sin(turn);
        // Scaled, turned counter-clockwise as seen with v downwards, moved.
        out.transform = {sx * c, sy * s, x, -sx * s, sy * c, y};
        out.set = static_cast<int>(number(t, "texCoord", out.set));
    }
    if (out.set > 1) {
        warn_(path, fmt::format("its texture lies on TEXCOORD_{}, which is not read; 0 and 1 are",
                                out.set));
        return {};
    }
    // A room is worth reading without its pictures; no limit is passed for them.
    try {
        out.texture = texture(static_cast<std::size_t>(info.index), most);
    } catch (const TooManyPixels& limit) {
        json_.refuse(path, limit.what);
    } catch (const std::runtime_error& why) {
        warn_(path, fmt::format("its texture cannot be read: {}", why.what()));
    }
    return out;
}

std::shared_ptr<const Texture> GltfTextures::texture(std::size_t index, double most) {
    auto& known = known_[{index, most}];
    if (known) return known;
    const JsonNode root{&json_, &json_.root(), ""};
    const JsonNode from = root.required("textures").element(index);
    TextureSampling sampling;
    if (const JsonNode which = from.member("sampler")) {
        const JsonNode samplers = root.required("samplers");
        const JsonNode sampler = samplers.element(which.index(samplers.array_size(), "samplers"));
        sampling.across = wrap_of(sampler, "wrapS");
        sampling.down = wrap_of(sampler, "wrapT");
        if (const JsonNode filter = sampler.member("magFilter"))
            sampling.nearest = filter.whole(0, 65535, "a filter") == nearest_filter;
    }
    const JsonNode source = from.member("source");
    if (!source) throw std::runtime_error("it is in none of the formats PNG and JPEG");
    const JsonNode images = root.required("images");
    const JsonNode image = images.element(source.index(images.array_size(), "images"));
    known = std::make_shared<const Texture>(picture(image), sampling, most);
    return known;
}

TexturePicture GltfTextures::picture(const JsonNode& image) {
    const std::string bytes = resources_.bytes(image);
    const ImageSizeInFile size = image_size(bytes);
    pixels_ += size.width * size.height;
    if (pixels_ > options_.max_texture_pixels)
        throw TooManyPixels{
            fmt::format("with this image of {} × {} the textures have more than {} "
                        "pixels; --max-texture-pixels raises the limit",
                        size.width, size.height, options_.max_texture_pixels)};
    return decode_image(bytes);
}

}  // namespace exitance
