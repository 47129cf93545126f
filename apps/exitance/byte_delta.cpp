// SPDX-License-Identifier: Apache-2.0
#include "byte_delta.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

namespace exitance::cli {

namespace {

// Numbers of a solution file are four bytes wide and aligned to that.
constexpr std::size_t grain = 4, block = 32;
constexpr std::uint32_t nowhere = 0xffffffff;

struct Piece {
    std::uint32_t from;  ///< offset in the old file, or `nowhere`
    std::uint32_t bytes;
};

/// Where each block of the old file begins, by its hash; of equal hashes, the first.
class Blocks {
  public:
    explicit Blocks(std::span<const char> old) : old_(old) {
        const std::size_t count = old.size() / block;
        slots_.assign(std::bit_ceil(2 * count + 1), nowhere);
        shift_ = 64 - std::countr_zero(slots_.size());
        for (std::size_t b = 0; b < count; ++b) {
            std::uint32_t& slot = slots_[hash(old.data() + b * block)];
            if (slot == nowhere) slot = static_cast<std::uint32_t>(b * block);
        }
    }

    /// Offset of a block equal to the one that begins at `bytes`, or `nowhere`.
    std::uint32_t find(const char* bytes) const {
        const std::uint32_t at = slots_[hash(bytes)];
        return at != nowhere && std::memcmp(old_.data() + at, bytes, block) == 0 ? at : nowhere;
    }

  private:
    std::span<const char> old_;
    std::vector<std::uint32_t> slots_;
    int shift_ = 0;

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    std::size_t hash(const char* bytes) const {
        std::uint64_t words[block / 8], sum = 0;
        std::memcpy(words, bytes, block);
        for (const std::uint64_t word : words)
            sum = (std::rotl(sum, 23) ^ word) * 0x9E3779B97F4A7C15u;
        return shift_ >= 64 ? 0 : static_cast<std::size_t>(sum >> shift_);
    }
};

class Comparison {
  public:
    Comparison(std::span<const char> old, std::span<const char> now)
        : old_(old), now_(now), blocks_(old) {}

    std::vector<Piece> pieces() {
        std::size_t misses = 0;
        while (at_ + block <= now_.size()) {
            const std::uint32_t from = match();
            if (from == nowhere) {
                // Where nothing has matched for long, look at fewer places.
                at_ += grain * (1 + misses++ / 64);
                continue;
            }
            misses = 0;
            copy(from);
        }
        add_new(now_.size());
        return std::move(pieces_);
    }

  private:
    std::span<const char> old_, now_;
    Blocks blocks_;
    std::vector<Piece> pieces_;
    std::size_t at_ = 0;      ///< looked at
    std::size_t done_ = 0;    ///< covered by pieces
    std::int64_t drift_ = 0;  ///< old offset minus new one of the last copy

    /// Where the block at `at_` comes from: best from where the last copy would go on.
    std::uint32_t match() const {
        const std::int64_t straight = static_cast<std::int64_t>(at_) + drift_;
        if (straight >= 0 && static_cast<std::size_t>(straight) + block <= old_.size() &&
            std::memcmp(old_.data() + straight, now_.data() + at_, block) == 0)
            return static_cast<std::uint32_t>(straight);
        return blocks_.find(now_.data() + at_);
    }

    /// Widens the match of the block at `at_` to both sides and makes it a piece.
    void copy(std::size_t from) {
        std::size_t begin = at_;
        while (begin > done_ && from > 0 && now_[begin - 1] == old_[from - 1]) --begin, --from;
        const std::size_t most = std::min(now_.size() - begin, old_.size() - from);
        const auto differ = std::mismatch(now_.begin() + static_cast<std::ptrdiff_t>(begin),
                                          now_.begin() + static_cast<std::ptrdiff_t>(begin + most),
                                          old_.begin() + static_cast<std::ptrdiff_t>(from));
        const auto end = static_cast<std::size_t>(differ.first - now_.begin());
        add_new(begin);
        pieces_.push_back(
            {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(end - begin)});
        drift_ = static_cast<std::int64_t>(from) - static_cast<std::int64_t>(begin);
        done_ = end;
        at_ = (end + grain - 1) / grain * grain;
    }

    void add_new(std::size_t end) {
        if (end > done_) pieces_.push_back({nowhere, static_cast<std::uint32_t>(end - done_)});
        done_ = end;
    }
};

void put(std::string& out, std::uint32_t word) {
    static_assert(std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

std::string make_delta(std::span<const char> before, std::span<const char> after,
                       std::uint32_t revision) {
    const std::vector<Piece> pieces = Comparison(before, after).pieces();
    std::size_t fresh = 0;
    for (const Piece& piece : pieces)
        if (piece.from == nowhere) fresh += piece.bytes;
    std::string out = "XDL1";
    out.reserve(16 + 8 * pieces.size() + fresh);
    put(out, revision);
    put(out, static_cast<std::uint32_t>(after.size()));
    put(out, static_cast<std::uint32_t>(pieces.size()));
    for (const Piece& piece : pieces) put(out, piece.from), put(out, piece.bytes);
    std::size_t at = 0;
    for (const Piece& piece : pieces) {
        if (piece.from == nowhere) out.append(after.data() + at, piece.bytes);
        at += piece.bytes;
    }
    return out;
}

}  // namespace exitance::cli
