// SPDX-License-Identifier: Apache-2.0
// Small inputs written out by hand, a folder to put them in, and what every reader owes to bad
// ones.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <regex>
#include <string>

#include "exitance/run/error.h"

namespace exitance::testing {

/// A folder of its own per test that goes away with it.
class Folder {
  public:
    Folder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "exitance-formats-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// The message of the Error(bad_input) that `read` throws; a test failure if it throws none.
inline std::string refusal(const std::function<void()>& read) {
    try {
        read();
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), 3) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "accepted, expected an Error";
    return "";
}

/// Expects that `read` throws Error(bad_input) with "file:line:column: …words…".
inline void expect_refused(const std::function<void()>& read, const std::string& place,
                           const std::string& words) {
    const std::string message = refusal(read);
    EXPECT_EQ(message.rfind(place + ": ", 0), 0U) << message << "\nis not at " << place;
    EXPECT_NE(message.find(words), std::string::npos) << message << "\ndoes not say: " << words;
}

/// Succeeds or throws Error(bad_input) whose message begins with `file` and, if `with_line`, a line
/// and a column; anything else is a failure.
inline void expect_sound(const std::function<void()>& read, const std::string& file,
                         bool with_line) {
    try {
        read();
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.exit_code(), 3) << message;
        EXPECT_EQ(message.rfind(file, 0), 0U) << message;
        const std::regex place(with_line ? "^:[0-9]+:[0-9]+: ." : "^(:[0-9]+:[0-9]+)?: .");
        EXPECT_TRUE(std::regex_search(message.substr(file.size()), place)) << message;
    }
}

/// Runs `read` in a child process that may use `megabytes` more address space than now, and tells
/// whether it ended by itself with success or Error (bad_alloc and crashes are not that). Under
/// AddressSanitizer, whose shadow needs all addresses, the limit is left out.
inline bool sound_within(std::size_t megabytes, const std::function<void()>& read) {
    const pid_t child = ::fork();
    if (child == 0) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t bytes = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) +
                             (static_cast<rlim_t>(megabytes) << 20);
        const rlimit limit{bytes, bytes};
        if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(3);
#else
        (void)megabytes;
#endif
        try {
            read();
        } catch (const Error&) {
        } catch (...) {
            ::_exit(1);
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Whether `read` took at most a second of processor time, of processes that it waited for too; ten
/// under the sanitizers.
inline bool quick(const std::function<void()>& read) {
    const auto spent = [] {
        double seconds = 0;
        for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
            rusage used{};
            ::getrusage(who, &used);
            for (const timeval& t : {used.ru_utime, used.ru_stime})
                seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
        }
        return seconds;
    };
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    constexpr double most = 10;
#else
    constexpr double most = 1;
#endif
    const double begin = spent();
    read();
    return spent() - begin < most;
}

/// A real scene that lies beside the project, if it is there.
inline std::optional<std::filesystem::path> beside_project(const std::string& name) {
    const auto path =
        std::filesystem::path(EXITANCE_SOURCE_DIR).parent_path() / "shared" / "scenes" / name;
    if (!std::filesystem::exists(path)) return std::nullopt;
    return path;
}

}  // namespace exitance::testing
