// SPDX-License-Identifier: Apache-2.0
// Lines of words of an MGF file; a backslash at the end of a line continues it.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "exitance/scene/formats/include_files.h"

namespace exitance {

class MgfLines {
  public:
    explicit MgfLines(std::shared_ptr<const SourceFile> file) : file_(std::move(file)) {}

    /// Moves to the next line that holds words and is no comment; false at the end of the file.
    bool next();
    /// Of the current line; views into the file's text.
    const std::vector<std::string_view>& words() const { return words_; }
    /// Characters of the current line, continuations included.
    std::size_t length() const { return at_ - begin_; }
    /// Lines passed by next() in its last call.
    std::size_t passed() const { return passed_; }

    /// A place to come back to: after the current line.
    struct Mark {
        std::size_t at, line;
    };
    Mark mark() const { return {at_, line_}; }
    void go_to(const Mark& mark) { at_ = mark.at, line_ = mark.line; }

    /// Line of the current line's first word.
    Place line_place() const;
    /// Line and column of a word; past the last word, the end of the line.
    Place place(std::size_t word) const;

  private:
    std::shared_ptr<const SourceFile> file_;
    std::vector<std::string_view> words_;
    std::size_t at_ = 0, line_ = 1;  // of what comes next
    std::size_t begin_ = 0, word_line_ = 1, passed_ = 0;
};

}  // namespace exitance
