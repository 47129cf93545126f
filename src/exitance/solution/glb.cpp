// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/glb.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <ostream>

#include "exitance/run/error.h"

namespace exitance {

static_assert(std::endian::native == std::endian::little, "glTF stores little-endian numbers");

namespace {

constexpr std::uint32_t magic = 0x46546C67;       // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

template <std::size_t n>
void put(std::ostream& out, const std::array<std::uint32_t, n>& words) {
    out.write(reinterpret_cast<const char*>(words.data()), sizeof words);
}

class Reader {
  public:
    explicit Reader(const std::filesystem::path& path) : name_(path.string()) {
        std::error_code failure;
        if (!std::filesystem::is_regular_file(path, failure))
            fail(failure ? failure.message() : "found no regular file, expected a solution (.glb)");
        file_.open(path, std::ios::binary);
        if (!file_) fail(std::strerror(errno));
        left_ = std::filesystem::file_size(path, failure);
        if (failure) fail(failure.message());
    }

    [[noreturn]] void fail(const std::string& what) const { throw Error(Place{name_}, what); }

    std::uint64_t left() const { return left_; }

    template <std::size_t n>
    std::array<std::uint32_t, n> words(const char* expected) {
        std::array<std::uint32_t, n> out{};
        read(out.data(), sizeof out, expected);
        return out;
    }

    void read(void* to, std::uint64_t bytes, const char* expected) {
        if (bytes > left_)
            fail(fmt::format("found {} bytes, expected {} of {}", left_, bytes, expected));
        file_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
        if (!file_) fail(fmt::format("cannot read {}", expected));
        left_ -= bytes;
    }

    void skip(std::uint64_t bytes) {
        file_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
        left_ -= bytes;
    }

  private:
    std::string name_;
    std::ifstream file_;
    std::uint64_t left_ = 0;
};

}  // namespace

GlbChunks read_glb(const std::filesystem::path& path, GlbContent content) {
    Reader in(path);
    const std::uint64_t size = in.left();
    const auto [found_magic, version, length] = in.words<3>("the header of a binary glTF");
    if (found_magic != magic) in.fail("found other data, expected a binary glTF (.glb)");
    if (version != 2) in.fail(fmt::format("found glTF version {}, expected 2", version));
    if (length != size)
        in.fail(fmt::format("found {} bytes, expected {} as the header says", size, length));

    GlbChunks chunks;
    const auto [json_length, json_type] = in.words<2>("the header of the JSON chunk");
    if (json_type != json_chunk) in.fail("found another chunk, expected JSON first");
    if (json_length > in.left())
        in.fail(fmt::format("found {} bytes, expected {} of JSON", in.left(), json_length));
    chunks.json.resize(json_length);
    in.read(chunks.json.data(), json_length, "JSON");

    while (content == GlbContent::all && in.left() > 0) {
        const auto [chunk_length, chunk_type] = in.words<2>("a chunk header");
        if (chunk_length > in.left())
            in.fail(fmt::format("found {} bytes, expected a chunk of {}", in.left(), chunk_length));
        if (chunk_type == bin_chunk && chunks.binary.empty()) {
            chunks.binary.resize(chunk_length);
            in.read(chunks.binary.data(), chunk_length, "the BIN chunk");
        } else {
            in.skip(chunk_length);
        }
    }
    return chunks;
}

void write_glb(std::ostream& out, std::string json, std::uint64_t binary_bytes,
               const std::function<void(std::ostream&)>& write_binary) {
    // Chunks are padded to four bytes, JSON with spaces, BIN with zeros.
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t padding = (4 - binary_bytes % 4) % 4;
    const std::uint64_t binary_chunk = binary_bytes ? 8 + binary_bytes + padding : 0;
    const std::uint64_t total = 12 + 8 + json.size() + binary_chunk;
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw Error(Fault::could_not_finish,
                    fmt::format("the file would be {} bytes, a .glb holds at most 4 GiB", total));
    const auto word = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
    put<3>(out, {magic, 2, word(total)});
    put<2>(out, {word(json.size()), json_chunk});
    out.write(json.data(), static_cast<std::streamsize>(json.size()));
    if (!binary_chunk) return;
    put<2>(out, {word(binary_bytes + padding), bin_chunk});
    write_binary(out);
    out.write("\0\0\0", static_cast<std::streamsize>(padding));
}

}  // namespace exitance
