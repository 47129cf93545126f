// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/source_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

namespace exitance {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

// Length of the UTF-8 sequence that `text` begins with; 0 if it is none (RFC 3629, section 4).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
    const unsigned first = byte(0), second = byte(1);
    if (first < 0x80U) return 1;
    if (first >= 0xc2U && first < 0xe0U) return continues(1) ? 2 : 0;
    if (first >= 0xe0U && first < 0xf0U) {
        const bool overlong = first == 0xe0U && second < 0xa0U;
        const bool surrogate = first == 0xedU && second > 0x9fU;
        return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (first >= 0xf0U && first < 0xf5U) {
        const bool overlong = first == 0xf0U && second < 0x90U;
        const bool beyond = first == 0xf4U && second > 0x8fU;
        return continues(1) && continues(2) && continues(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
}

// Continuation bytes of UTF-8 do not start a character.
std::size_t characters(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
    }));
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& path, std::uint64_t most) {
    const Place place{path.string(), 0, 0};
    std::error_code failure;
    const auto status = std::filesystem::status(path, failure);
    if (!std::filesystem::exists(status)) throw Error(place, "there is no such file");
    if (std::filesystem::is_directory(status))
        throw Error(place, "this is a folder, expected a file");
    if (!std::filesystem::is_regular_file(status))
        throw Error(place, "this is a device or pipe, expected a file");
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw Error(place, "the file cannot be opened for reading");
    const std::streamoff size = file.tellg();
    if (size < 0) throw Error(place, "the file cannot be read");
    if (static_cast<std::uint64_t>(size) > most)
        throw Error(place,
                    fmt::format("the file has {} bytes, more than {}; --max-file-size raises "
                                "the limit",
                                size, most));
    std::string bytes(static_cast<std::size_t>(size), '\0');
    file.seekg(0);
    file.read(bytes.data(), size);
    if (file.gcount() != size) throw Error(place, "the file cannot be read to its end");
    return bytes;
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string out = path.extension().string();
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

Place place_at(const std::string& file, std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    // Of old files, lines end with CR alone.
    const char end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
    const auto lines = static_cast<std::size_t>(std::count(before.begin(), before.end(), end));
    const std::size_t newline = before.rfind(end);
    const std::size_t line_begin = newline == std::string_view::npos ? 0 : newline + 1;
    return {file, lines + 1, characters(before.substr(line_begin)) + 1};
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    std::string out = "'";
    for (const char c : text.substr(0, most)) out += c >= ' ' && c <= '~' ? c : '?';
    return out + (text.size() > most ? "…'" : "'");
}

std::string as_utf8(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t n = utf8_length(text);
        const auto byte = static_cast<unsigned char>(text[0]);
        if (n > 1)
            out += text.substr(0, n);
        else if (n == 1)
            out += byte < 0x20U || byte == 0x7fU ? ' ' : text[0];
        else {
            out += static_cast<char>(0xc0U | (byte >> 6));
            out += static_cast<char>(0x80U | (byte & 0x3fU));
        }
        text.remove_prefix(std::max<std::size_t>(n, 1));
    }
    return out;
}

std::optional<double> finite_number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data(), end, value);
    if (text.empty() || failure != std::errc{} || rest != end || !std::isfinite(value))
        return std::nullopt;
    return value;
}

TextCursor::TextCursor(std::string file, std::string_view text)
    : file_(std::move(file)), text_(text) {}

void TextCursor::skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

std::string_view TextCursor::rest_of_line() {
    skip_blanks();
    const std::size_t newline = std::min(text_.find('\n', at_), text_.size());
    std::string_view rest = text_.substr(at_, newline - at_);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    at_ = newline;
    if (at_ < text_.size()) {
        line_begin_ = ++at_;
        ++line_;
    }
    return rest;
}

bool TextCursor::next_line() {
    while (line_ended()) {
        if (at_ == text_.size()) return false;
        line_begin_ = ++at_;
        ++line_;
    }
    return true;
}

bool TextCursor::line_ended() {
    skip_blanks();
    return at_ == text_.size() || text_[at_] == '\n';
}

std::string_view TextCursor::word(std::string_view expected) {
    if (line_ended())
        throw Error(here(), fmt::format("found the end of the {}, expected {}",
                                        at_ == text_.size() ? "file" : "line", expected));
    word_begin_ = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') ++at_;
    word_ = text_.substr(word_begin_, at_ - word_begin_);
    return word_;
}

bool TextCursor::take(std::string_view keyword) {
    if (line_ended()) return false;
    const std::size_t before = at_;
    if (word("") == keyword) return true;
    at_ = before;
    return false;
}

void TextCursor::end_line(std::string_view expected) {
    if (line_ended()) return;
    word("");
    refuse(expected);
}

double TextCursor::number(std::string_view expected, double least, double most) {
    const auto value = finite_number(word(expected));
    if (!value || *value < least || *value > most) refuse(expected);
    return *value;
}

double TextCursor::number(std::string_view expected) {
    return number(expected, std::numeric_limits<double>::lowest(),
                  std::numeric_limits<double>::max());
}

std::uint32_t TextCursor::count(std::string_view expected, std::uint32_t least,
                                std::uint32_t most) {
    word(expected);
    std::uint32_t value = 0;
    const char* end = word_.data() + word_.size();
    const auto [rest, failure] = std::from_chars(word_.data(), end, value);
    if (failure != std::errc{} || rest != end || value < least || value > most) refuse(expected);
    return value;
}

Place TextCursor::place_of(std::size_t offset) const {
    return {file_, line_, characters(text_.substr(line_begin_, offset - line_begin_)) + 1};
}

Place TextCursor::place() const {
    return place_of(word_begin_);
}

Place TextCursor::here() const {
    return place_of(at_);
}

void TextCursor::refuse(std::string_view expected) const {
    throw Error(place(), fmt::format("found {}, expected {}", in_quotes(word_), expected));
}

}  // namespace exitance
