// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/rad_tokens.h"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v' || c == '\n';
}

}  // namespace

void RadTokens::skip() {
    const std::string_view text = file_->text;
    while (at_ < text.size()) {
        if (text[at_] == '#')
            at_ = std::min(text.find('\n', at_), text.size());
        else if (is_blank(text[at_]))
            line_ += text[at_++] == '\n' ? 1 : 0;
        else
            return;
    }
}

std::optional<std::string> RadTokens::command() {
    skip();
    const std::string_view text = file_->text;
    if (at_ == text.size() || text[at_] != '!') return std::nullopt;
    begin_ = at_++;
    word_line_ = line_;
    word_ = text.substr(begin_, 1);
    std::string out;
    for (; at_ < text.size(); ++at_) {
        const char c = text[at_];
        if (c == '\r') continue;
        if (c == '\n') {
            if (out.empty() || out.back() != '\\') break;
            out.back() = ' ';
            ++line_;
            continue;
        }
        out += c;
    }
    return out;
}

bool RadTokens::ended() {
    skip();
    return at_ == file_->text.size();
}

std::string_view RadTokens::word(const char* expected) {
    const std::string_view text = file_->text;
    if (ended()) {
        begin_ = text.size();
        word_line_ = line_;
        throw Error(place(), fmt::format("found the end of the file, expected {}", expected));
    }
    begin_ = at_;
    word_line_ = line_;
    while (at_ < text.size() && !is_blank(text[at_])) ++at_;
    return word_ = text.substr(begin_, at_ - begin_);
}

Place RadTokens::place() const {
    return origin_ ? *origin_ : place_at(file_->path.string(), file_->text, begin_);
}

Place RadTokens::line_place() const {
    return origin_ ? *origin_ : Place{file_->path.string(), word_line_, 0};
}

void RadTokens::refuse(const std::string& expected) const {
    throw Error(place(), fmt::format("found {}, expected {}", in_quotes(word_), expected));
}

}  // namespace exitance
