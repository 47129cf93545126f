// SPDX-License-Identifier: Apache-2.0
// Words of a Radiance scene description, its comments and commands.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "exitance/scene/formats/include_files.h"

namespace exitance {

class RadTokens {
  public:
    /// `origin` is where all of it stands, if the text was generated.
    RadTokens(std::shared_ptr<const SourceFile> file, std::optional<Place> origin)
        : file_(std::move(file)), origin_(std::move(origin)) {}

    /// The next thing is a command: the rest of its line after '!', with continuations.
    std::optional<std::string> command();
    /// No word is left.
    bool ended();
    /// The next word. Throws Error at the end of the file: `expected` was expected.
    std::string_view word(const char* expected);

    /// Line and column of the word or command taken last.
    Place place() const;
    /// The line alone.
    Place line_place() const;
    /// Throws Error at the word taken last.
    [[noreturn]] void refuse(const std::string& expected) const;

  private:
    void skip();

    std::shared_ptr<const SourceFile> file_;
    std::optional<Place> origin_;
    std::string_view word_;
    std::size_t at_ = 0, line_ = 1, begin_ = 0, word_line_ = 1;
};

}  // namespace exitance
