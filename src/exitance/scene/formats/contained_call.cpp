// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/contained_call.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

#include "exitance/run/error.h"

namespace exitance {

namespace {

// First byte of what the child sends; without it, the child did not get to its end.
constexpr char returned = 'R', threw = 'E', out_of_memory = 'M';

void limit(int resource, std::uint64_t value) {
    rlimit now{};
    if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &now) != 0) return;
    now.rlim_cur = std::min<rlim_t>(value, now.rlim_max);
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

void take_limits(const CallLimits& limits) {
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, limits.seconds);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    // (The sanitizers' shadow memory needs all addresses.)
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    limit(RLIMIT_AS, pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + limits.memory);
#endif
}

bool send(int to, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t sent = ::write(to, bytes, count);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes += sent;
        count -= static_cast<std::size_t>(sent);
    }
    return true;
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, const CallLimits& limits,
                               int to) {
    // Crashes end this process quietly, whatever handlers the parent has.
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE})
        ::signal(signal, SIG_DFL);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (nowhere >= 0) {
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
    }
    take_limits(limits);
    char kind = returned;
    std::string bytes;
    try {
        bytes = work();
    } catch (const std::bad_alloc&) {
        kind = out_of_memory;
    } catch (const std::exception& error) {
        kind = threw;
        bytes = error.what();
    } catch (...) {
        kind = threw;
        bytes = "an unknown exception";
    }
    const bool sent = send(to, &kind, 1) && send(to, bytes.data(), bytes.size());
    ::_exit(sent ? 0 : 1);
}

std::string receive(int from) {
    std::string out;
    std::array<char, 65536> buffer;
    while (true) {
        const ssize_t got = ::read(from, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return out;
        out.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

// The other end of the process: closed and waited for, whatever happens.
class Child {
  public:
    Child(pid_t id, int pipe) : id_(id), pipe_(pipe) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ == 0) return;
        ::kill(id_, SIGKILL);
        end();
    }

    /// How it ended, as waitpid() says.
    int end() {
        ::close(pipe_);
        int status = 0;
        while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = 0;
        return status;
    }

  private:
    pid_t id_;
    int pipe_;
};

}  // namespace

std::string contained_call(const std::function<std::string()>& work, const CallLimits& limits) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw Error(Fault::could_not_finish,
                    fmt::format("no pipe to another process: {}", std::strerror(errno)));
    const pid_t id = ::fork();
    if (id == 0) be_the_child(work, limits, ends[1]);
    const int failure = errno;
    ::close(ends[1]);
    if (id < 0) {
        ::close(ends[0]);
        throw Error(Fault::could_not_finish,
                    fmt::format("no other process can be started: {}", std::strerror(failure)));
    }
    Child child(id, ends[0]);
    std::string bytes = receive(ends[0]);
    const int status = child.end();
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        throw CallFailed(fmt::format("it took more than {} s", limits.seconds));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || bytes.empty())
        throw CallFailed("reading it crashed");
    const char kind = bytes[0];
    bytes.erase(0, 1);
    if (kind == out_of_memory)
        throw CallFailed(fmt::format("the importer ran out of memory, it needs more than {} MiB",
                                     limits.memory / (1024 * 1024)));
    if (kind == threw) throw CallFailed(bytes);
    return bytes;
}

}  // namespace exitance
