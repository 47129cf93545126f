// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf_lines.h"

#include "exitance/scene/formats/source_text.h"

namespace exitance {

bool MgfLines::next() {
    const std::string_view text = file_->text;
    passed_ = 0;
    while (at_ < text.size()) {
        words_.clear();
        begin_ = at_;
        word_line_ = line_;
        std::size_t word = at_;
        const auto end_word = [&](std::size_t end) {
            if (end > word) words_.push_back(text.substr(word, end - word));
            word = end + 1;
        };
        bool ended = false;
        for (; at_ < text.size() && !ended; ++at_) {
            const char c = text[at_];
            if (c == '\n') {
                // A backslash just before, maybe with a carriage return in between, continues.
                const std::size_t before = at_ > 0 && text[at_ - 1] == '\r' ? at_ - 1 : at_;
                const bool continues = before > begin_ && text[before - 1] == '\\';
                if (continues && word < before - 1)
                    end_word(before - 1);
                else if (!continues)
                    end_word(at_);
                word = at_ + 1;
                ended = !continues;
                ++line_;
                ++passed_;
            } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
                // The carriage return after a continuing backslash ends no word.
                const bool continues = c == '\r' && at_ > begin_ && text[at_ - 1] == '\\' &&
                                       at_ + 1 < text.size() && text[at_ + 1] == '\n';
                if (!continues) end_word(at_);
            }
        }
        if (!ended) {
            end_word(text.size());
            ++passed_;
        }
        if (!words_.empty() && words_[0][0] != '#') return true;
    }
    words_.clear();
    return false;
}

Place MgfLines::line_place() const {
    return {file_->path.string(), word_line_, 0};
}

Place MgfLines::place(std::size_t word) const {
    const std::string_view text = file_->text;
    const char* at = word < words_.size() ? words_[word].data()
                     : words_.empty()     ? text.data() + begin_
                                          : words_.back().data() + words_.back().size();
    return place_at(file_->path.string(), text, static_cast<std::size_t>(at - text.data()));
}

}  // namespace exitance
