// SPDX-License-Identifier: Apache-2.0
// The words that move, turn, scale, mirror and repeat things in MGF and Radiance:
// -t x y z  -rx -ry -rz degrees  -s factor  -mx -my -mz  -i n …  -a n …
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "exitance/math/transform.h"
#include "exitance/run/error.h"

namespace exitance {

/// A similarity (turns, moves, one scale, mirrors), maybe of an array of copies.
class SimilarityArguments {
  public:
    /// Takes words from the front of `words` as long as they are arguments; `taken` says how many.
    /// `place(i)` is where word i stands. Throws Error at a number that is none, a scale of zero,
    /// or a count below 1.
    template <class PlaceOf>
    SimilarityArguments(std::span<const std::string_view> words, const PlaceOf& place) {
        parse(words);
        if (wrong_ < words.size() || expected_ != nullptr) refuse(words, place(wrong_));
    }
    SimilarityArguments() = default;

    std::size_t taken() const { return taken_; }
    bool is_array() const;
    /// Number of copies: the product of all -a, at most 2^63.
    std::uint64_t copies() const;
    /// The map of copy number `index`; the last -a varies fastest.
    Transform copy(std::uint64_t index) const;
    /// Which element of each -a that copy is.
    std::vector<std::uint64_t> indices(std::uint64_t index) const;

  private:
    struct Part {
        Transform map;
        std::uint64_t count = 1;
        bool array = false;
    };
    void parse(std::span<const std::string_view> words);
    [[noreturn]] void refuse(std::span<const std::string_view> words, const Place& place) const;

    std::vector<Part> parts_{Part{}};
    std::size_t taken_ = 0, wrong_ = static_cast<std::size_t>(-1);
    const char* expected_ = nullptr;
};

/// One scale of a similarity; negative lengths are never returned.
double scale_of(const Transform& similarity);

}  // namespace exitance
