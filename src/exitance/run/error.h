// SPDX-License-Identifier: Apache-2.0
// The one exception the library throws; the command line turns it into an exit code.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace exitance {

/// Where in a file something was found; line and column count from 1, 0 = not applicable.
struct Place {
    std::string file;
    std::size_t line = 0, column = 0;

    /// "file:line:column", as much of it as is known.
    std::string text() const;
};

enum class Fault {
    wrong_use,        ///< exit code 2
    bad_input,        ///< exit code 3
    could_not_finish  ///< exit code 4: disk full, out of memory
};

class Error : public std::runtime_error {
  public:
    Error(Fault fault, const std::string& message);
    /// `message` says what was found and what was expected; `place` is put before it.
    Error(const Place& place, const std::string& message);

    Fault fault() const { return fault_; }
    int exit_code() const;

  private:
    Fault fault_;
};

/// The candidate closest to `word` by edit distance, as ", did you mean 'x'?"; empty if none is
/// near.
std::string suggestion(const std::string& word, const std::string* first, const std::string* last);

template <class Container>
std::string suggestion(const std::string& word, const Container& candidates) {
    return suggestion(word, std::data(candidates), std::data(candidates) + std::size(candidates));
}

}  // namespace exitance
