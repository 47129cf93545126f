// SPDX-License-Identifier: Apache-2.0
// Ctrl-C asks long work to stop and keep what it has; a second one ends the program at once.
#pragma once

#include "exitance/run/progress.h"

namespace exitance::cli {

/// What is said on stderr at once, a line each.
struct Replies {
    const char* first = "";
    const char* second = "";
};

/// While one lives, the first SIGINT or SIGTERM requests `cancel()`. One at a time.
class Interrupt {
  public:
    explicit Interrupt(const Replies& replies = {});
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const Cancel& cancel() const { return cancel_; }

    /// For the handler of signals, which may call no more than this does.
    void hear() const;

  private:
    mutable Cancel cancel_;
    Replies replies_;
};

}  // namespace exitance::cli
