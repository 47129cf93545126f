// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/error.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace exitance {

std::string Place::text() const {
    std::string out = file;
    if (line > 0) out += ":" + std::to_string(line);
    if (line > 0 && column > 0) out += ":" + std::to_string(column);
    return out;
}

Error::Error(Fault fault, const std::string& message)
    : std::runtime_error(message), fault_(fault) {}

Error::Error(const Place& place, const std::string& message)
    : std::runtime_error(place.text() + ": " + message), fault_(Fault::bad_input) {}

int Error::exit_code() const {
    switch (fault_) {
        case Fault::wrong_use:
            return 2;
        case Fault::bad_input:
            return 3;
        case Fault::could_not_finish:
            return 4;
    }
    return 4;
}

namespace {

// Levenshtein distance, one row at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replace});
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::string& word, const std::string* first, const std::string* last) {
    const std::string* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (; first != last; ++first) {
        const std::size_t d = edit_distance(word, *first);
        if (d < best_distance) {
            best_distance = d;
            best = first;
        }
    }
    return best ? ", did you mean '" + *best + "'?" : "";
}

}  // namespace exitance
