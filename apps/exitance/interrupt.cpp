// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <array>
#include <atomic>
#include <csignal>

namespace exitance::cli {

namespace {

constexpr std::array<int, 2> signals{SIGINT, SIGTERM};

std::atomic<Cancel*> current{nullptr};  // a signal handler has no other way to be told
static_assert(std::atomic<Cancel*>::is_always_lock_free);

extern "C" void request_cancel(int signal) {
    if (Cancel* cancel = current.load()) cancel->request();
    std::signal(signal, SIG_DFL);  // a second one ends the program
}

}  // namespace

Interrupt::Interrupt() {
    current = &cancel_;
    for (const int signal : signals) std::signal(signal, request_cancel);
}

Interrupt::~Interrupt() {
    for (const int signal : signals) std::signal(signal, SIG_DFL);
    current = nullptr;
}

}  // namespace exitance::cli
