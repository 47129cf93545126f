// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace exitance::cli {

namespace {

constexpr std::array<int, 2> signals{SIGINT, SIGTERM};

std::atomic<const Interrupt*> current{nullptr};  // a signal handler has no other way to be told
static_assert(std::atomic<const Interrupt*>::is_always_lock_free);

extern "C" void hear_signal(int signal) {
    const int before = errno;
    const Interrupt* const interrupt = current.load();
    const bool again = !interrupt || interrupt->cancel().requested();
    if (interrupt) interrupt->hear();
    errno = before;
    if (!again) return;
    std::signal(signal, SIG_DFL);  // as nobody hears it
    std::raise(signal);
}

}  // namespace

Interrupt::Interrupt(const Replies& replies) : replies_(replies) {
    current = this;
    for (const int signal : signals) std::signal(signal, hear_signal);
}

void Interrupt::hear() const {
    const char* reply = cancel_.requested() ? replies_.second : replies_.first;
    cancel_.request();
    // Off the line of a progress bar. There is nobody to tell if that fails.
    if (*reply != '\0' && ::isatty(STDERR_FILENO) && ::write(STDERR_FILENO, "\n", 1) < 0) return;
    if (::write(STDERR_FILENO, reply, std::strlen(reply)) < 0) return;
}

Interrupt::~Interrupt() {
    for (const int signal : signals) std::signal(signal, SIG_DFL);
    current = nullptr;
}

}  // namespace exitance::cli
