// SPDX-License-Identifier: Apache-2.0
// How long work reports where it is and how it is asked to stop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace exitance {

/// One report of a long computation; `fraction_left` falls from 1 to 0 and comes from the residual.
struct Progress {
    std::string phase;         ///< what is being done: "direct", "shooting", "estimate"
    double seconds = 0;        ///< since the work began
    double fraction_left = 1;  ///< unshot energy / emitted energy, or work left / all work
    bool even = false;         ///< fraction_left is work left, which falls evenly with time
    std::optional<double> fraction_target;  ///< fraction_left at which the work is done, if known
    std::uint64_t shots = 0;
    std::uint64_t rays = 0;  ///< visibility rays so far
    std::uint64_t vertices = 0;
    std::optional<double> error;  ///< RMS relative error of irradiance, once estimated
    // Of solvers of the linear system of elements:
    std::optional<double> sweeps;    ///< work so far in products with the whole matrix
    std::optional<double> residual;  ///< of the system, relative to that at the start
    std::vector<double> exitance{};  ///< luminance of B, of small systems alone
};

using Observer = std::function<void(const Progress&)>;

/// Set from a signal handler or another thread; work looks at it between shots.
class Cancel {
  public:
    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> requested_{false};
};

/// Wall-clock seconds since construction.
class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace exitance
