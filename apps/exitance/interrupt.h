// SPDX-License-Identifier: Apache-2.0
// Ctrl-C asks long work to stop and keep what it has; a second one ends the program at once.
#pragma once

#include "exitance/run/progress.h"

namespace exitance::cli {

/// While one lives, the first SIGINT or SIGTERM requests `cancel()`. One at a time.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const Cancel& cancel() const { return cancel_; }

  private:
    Cancel cancel_;
};

}  // namespace exitance::cli
