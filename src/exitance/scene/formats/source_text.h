// SPDX-License-Identifier: Apache-2.0
// The bytes of an input file, and where in them something stands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "exitance/run/error.h"

namespace exitance {

/// Whole contents of a regular file. Throws Error(bad_input) if it is missing, a folder, a device,
/// unreadable or larger than `most` bytes (--max-file-size).
std::string read_whole_file(const std::filesystem::path& path,
                            std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// The ending of its name, from the last dot, in lower case.
std::string lower_extension(const std::filesystem::path& path);

/// Line and column (both from 1, columns in characters) of the byte at `offset` of `text`.
Place place_at(const std::string& file, std::string_view text, std::size_t offset);

/// `text` in quotes as a message can show it: one line, at most 40 characters, unprintable bytes
/// as '?'.
std::string in_quotes(std::string_view text);

/// `text` as valid UTF-8 without control characters: bytes that are not are taken as Latin-1.
std::string as_utf8(std::string_view text);

/// The finite number that the whole of `text` spells, if it does.
std::optional<double> finite_number(std::string_view text);

/// Walks over a text of lines of words. Blank lines are skipped; blanks are space, tab and CR.
class TextCursor {
  public:
    /// Keeps `text` by reference. `file` is what errors name.
    TextCursor(std::string file, std::string_view text);

    /// The rest of the current line without blanks at its ends; the cursor moves to the next line.
    std::string_view rest_of_line();
    /// Moves to the next line that holds a word (the current one, if a word is left on it);
    /// false at the end of the text.
    bool next_line();
    /// No word is left on the current line.
    bool line_ended();

    /// The next word on this line. Throws Error: the line ended, `expected` was expected.
    std::string_view word(std::string_view expected);
    /// Takes the next word on this line if it is `keyword`.
    bool take(std::string_view keyword);
    /// Throws Error if a word is left on this line.
    void end_line(std::string_view expected);

    /// A finite number within [least, most]; throws Error at the word that is not.
    double number(std::string_view expected, double least, double most);
    double number(std::string_view expected);
    /// A whole number within [least, most]; throws Error at the word that is not.
    std::uint32_t count(std::string_view expected, std::uint32_t least, std::uint32_t most);

    /// Where the word taken last began.
    Place place() const;
    /// Where the cursor stands.
    Place here() const;
    /// Throws Error at the word taken last: "found 'word', expected …".
    [[noreturn]] void refuse(std::string_view expected) const;

  private:
    void skip_blanks();
    Place place_of(std::size_t offset) const;

    std::string file_;
    std::string_view text_;
    std::size_t at_ = 0, line_begin_ = 0, line_ = 1;
    std::size_t word_begin_ = 0;
    std::string_view word_;
};

}  // namespace exitance
