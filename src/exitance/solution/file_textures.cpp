// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_textures.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "exitance/scene/formats/image_file.h"

namespace exitance::solution_file {

using nlohmann::json;

namespace {

// Codes of OpenGL (glTF 2.0, section 5.26).
constexpr int nearest = 9728, linear = 9729, linear_mipmap_linear = 9987;
constexpr int repeat = 10497, clamp_to_edge = 33071, mirrored_repeat = 33648;
// More than any scene is read with by default, and what a small file can ask for.
constexpr std::uint64_t most_pixels = 400'000'000;

int code_of(TextureWrap wrap) {
    return wrap == TextureWrap::clamp    ? clamp_to_edge
           : wrap == TextureWrap::mirror ? mirrored_repeat
                                         : repeat;
}

TextureWrap wrap_of(const Node& code) {
    switch (code.count()) {
        case repeat:
            return TextureWrap::repeat;
        case clamp_to_edge:
            return TextureWrap::clamp;
        case mirrored_repeat:
            return TextureWrap::mirror;
        default:
            code.refuse(fmt::format("{}, {} or {}", repeat, clamp_to_edge, mirrored_repeat));
    }
}

}  // namespace

TexturesOut::TexturesOut(const Solution& solution) {
    for (const Material& material : solution.materials)
        for (const Pattern* pattern : {&material.reflectance_pattern, &material.exitance_pattern}) {
            if (!*pattern || index_.count(pattern->texture.get()) > 0) continue;
            index_.emplace(pattern->texture.get(), textures_.size());
            textures_.push_back(pattern->texture.get());
            try {
                images_.push_back(encode_png(pattern->texture->picture()));
            } catch (const std::runtime_error& why) {
                throw Error(Fault::could_not_finish, why.what());
            }
        }
}

void TexturesOut::describe(json& gltf, std::size_t first_view) const {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const TextureSampling& sampling = textures_[i]->sampling();
        gltf["images"].push_back({{"bufferView", first_view + i}, {"mimeType", "image/png"}});
        gltf["samplers"].push_back({{"wrapS", code_of(sampling.across)},
                                    {"wrapT", code_of(sampling.down)},
                                    {"magFilter", sampling.nearest ? nearest : linear},
                                    {"minFilter", linear_mipmap_linear}});
        gltf["textures"].push_back({{"source", i}, {"sampler", i}});
    }
}

TexturesIn::TexturesIn(const Node& root, BytesOfView bytes)
    : root_(root), bytes_(std::move(bytes)) {}

Pattern TexturesIn::pattern(const Node& description, std::size_t bands) {
    if (bands != 3) description.refuse("patterns in three bands only");
    Pattern out;
    out.factor = description["factor"].spectrum(bands, std::numeric_limits<double>::max());
    out.texture = texture(description["texture"], description["most"].number_within(0, 1));
    return out;
}

std::shared_ptr<const Texture> TexturesIn::texture(const Node& index, double most) {
    const Node textures = root_["textures"];
    const std::uint64_t number = index.index_below(textures.size());
    auto& known = known_[{number, most}];
    if (known) return known;
    const Node entry = textures[number];
    const Node samplers = root_["samplers"], images = root_["images"], views = root_["bufferViews"];
    const Node sampler = samplers[entry["sampler"].index_below(samplers.size())];
    const TextureSampling sampling{wrap_of(sampler["wrapS"]), wrap_of(sampler["wrapT"]),
                                   sampler["magFilter"].count() == nearest};
    const Node image = images[entry["source"].index_below(images.size())];
    const std::string_view bytes = bytes_(views[image["bufferView"].index_below(views.size())]);
    try {
        const ImageSizeInFile size = image_size(bytes);
        pixels_ += size.width * size.height;
        if (pixels_ > most_pixels)
            image.refuse(fmt::format("textures of at most {} pixels", most_pixels));
        known = std::make_shared<const Texture>(decode_image(bytes), sampling, most);
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& why) {
        image.refuse(fmt::format("a PNG ({})", why.what()));
    }
    return known;
}

}  // namespace exitance::solution_file
