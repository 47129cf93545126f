// SPDX-License-Identifier: Apache-2.0
// Calls into libraries that do not withstand hostile files, in a process of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace exitance {

/// The call did not come to its end.
class CallFailed : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What a contained call may use.
struct CallLimits {
    std::uint64_t memory = std::uint64_t{1} << 32;  ///< beyond what this process has now [bytes]
    std::uint64_t seconds = 60;                     ///< of processor time
};

/// Runs `work` in a copy of this process and returns the bytes that it returns. Nothing that it
/// does to memory comes back, and what it prints is dropped. `work` must not use other threads.
/// Throws CallFailed with the text of the exception that `work` threw, or that says how it ended:
/// it crashed, or used up its memory or time.
std::string contained_call(const std::function<std::string()>& work, const CallLimits& limits);

}  // namespace exitance
