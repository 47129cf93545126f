// SPDX-License-Identifier: Apache-2.0
// How much a file may make: lines that are read and polygons, counted as often as arrays repeat
// them, so that too much is refused on the first copy.
#pragma once

#include <cstdint>

#include "exitance/run/error.h"
#include "exitance/scene/read_options.h"

namespace exitance {

class ReadBudget {
  public:
    explicit ReadBudget(const ReadOptions& options)
        : lines_{options.max_lines}, polygons_{options.max_polygons} {}

    /// What is spent from now on will be spent this often in all, this time included.
    void expect_repetitions(std::uint64_t times) {
        times_ = times;
        if (times == 1) lines_.promised = polygons_.promised = 0;
    }
    // Each throws Error, at `place()`, if there would be more than allowed.
    template <class PlaceOf>
    void spend_lines(std::uint64_t count, const PlaceOf& place) {
        if (!lines_.spend(count, times_)) refuse(place(), lines_.most, "lines", "--max-lines");
    }
    template <class PlaceOf>
    void spend_polygons(std::uint64_t count, const PlaceOf& place) {
        if (!polygons_.spend(count, times_))
            refuse(place(), polygons_.most, "polygons", "--max-polygons");
    }

  private:
    struct Account {
        std::uint64_t most, spent = 0, promised = 0;

        bool spend(std::uint64_t count, std::uint64_t times) {
            if (count > most || times > most) return false;
            spent += count;
            const std::uint64_t more =
                count > 0 && times - 1 > most / count ? most + 1 : count * (times - 1);
            promised += more;
            return spent <= most && promised <= most - spent;
        }
    };
    [[noreturn]] static void refuse(const Place& place, std::uint64_t most, const char* what,
                                    const char* option);

    Account lines_, polygons_;
    std::uint64_t times_ = 1;
};

}  // namespace exitance
