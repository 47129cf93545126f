// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/gltf_resources.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/include_files.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace fs = std::filesystem;

namespace {

int hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// %20 and the like (RFC 3986, section 2.1); a lone % stands for itself.
std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool code = uri[i] == '%' && i + 2 < uri.size() && hexadecimal(uri[i + 1]) >= 0 &&
                          hexadecimal(uri[i + 2]) >= 0;
        out += code ? static_cast<char>(16 * hexadecimal(uri[i + 1]) + hexadecimal(uri[i + 2]))
                    : uri[i];
        if (code) i += 2;
    }
    return out;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// RFC 4648, section 4; ends at the padding or at what is no digit.
std::string base64_decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) break;
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        if ((count += 6) < 8) continue;
        count -= 8;
        out += static_cast<char>(bits >> count & 0xffU);
    }
    return out;
}

bool is_data(const std::string& uri) {
    return uri.rfind("data:", 0) == 0;
}

}  // namespace

std::optional<fs::path> file_of_uri(const std::string& uri, const fs::path& folder) {
    if (is_data(uri)) return std::nullopt;
    return folder / percent_decoded(uri);
}

bool is_file_below(const fs::path& path, const fs::path& folder) {
    std::error_code failure;
    return fs::is_regular_file(path, failure) && leads_into(path, folder);
}

GltfResources::GltfResources(const fs::path& path, const tinygltf::Model& model,
                             const JsonText& json, std::uint64_t most_bytes)
    : folder_(path.parent_path()), model_(model), json_(json), most_bytes_(most_bytes) {}

std::string GltfResources::bytes(const JsonNode& owner) const {
    if (const JsonNode where = owner.member("bufferView")) {
        const std::size_t i = where.index(model_.bufferViews.size(), "bufferViews");
        const tinygltf::BufferView& view = model_.bufferViews[i];
        const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
            json_.refuse(where.path, fmt::format("bufferViews[{}] reaches beyond its buffer", i));
        return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
    }
    const JsonNode where = owner.required("uri");
    const std::string& uri = where.string();
    if (is_data(uri)) {
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos) json_.refuse(where.path, "a data URI without data");
        const std::string_view text = std::string_view(uri).substr(comma + 1);
        return uri.rfind(";base64", comma) != std::string::npos
                   ? base64_decoded(text)
                   : percent_decoded(std::string(text));
    }
    const fs::path file = folder_ / percent_decoded(uri);
    if (!is_file_below(file, folder_))
        json_.refuse(where.path, fmt::format("found {}, expected a file in the folder of the glTF",
                                             in_quotes(uri)));
    return read_whole_file(file, most_bytes_);
}

std::string GltfResources::name(const JsonNode& owner, const std::string& otherwise) const {
    const JsonNode where = owner.member("uri");
    if (!where || is_data(where.string())) return otherwise;
    return (folder_ / percent_decoded(where.string())).string();
}

}  // namespace exitance
