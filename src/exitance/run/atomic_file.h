// SPDX-License-Identifier: Apache-2.0
// Files appear whole or not at all.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "exitance/run/error.h"

namespace exitance {

/// A file that is written beside its place and moved there by `commit()`; without it, nothing
/// stays. What exists and is not a regular file (a device, a pipe) is written in place. A symbolic
/// link stays, its target is replaced. Every failure is Error(could_not_finish).
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path) : path_(path), target_(path) {
        std::error_code unknown;
        const auto kind = std::filesystem::status(path, unknown).type();
        using std::filesystem::file_type;
        if (kind == file_type::directory) fail(EISDIR);
        in_place_ = kind != file_type::regular && kind != file_type::not_found &&
                    kind != file_type::none && kind != file_type::unknown;
        if (kind == file_type::regular) target_ = std::filesystem::canonical(path, unknown);
        temporary_ = target_;
        if (!in_place_) temporary_ += "." + std::to_string(::getpid()) + ".tmp";
        errno = 0;
        stream_.open(temporary_, std::ios::binary);
        if (!stream_) fail(errno);
        open_ = true;
    }
    ~AtomicFile() { discard(); }
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    std::ostream& stream() { return stream_; }

    void commit() {
        if (stream_) errno = 0;  // else it says why an earlier write failed
        stream_.close();
        if (!stream_) fail(errno);
        std::error_code failure;
        if (!in_place_) std::filesystem::rename(temporary_, target_, failure);
        if (failure) fail(failure.value());
        open_ = false;
    }

  private:
    void discard() {
        if (!open_) return;
        stream_.close();
        std::error_code ignored;
        if (!in_place_) std::filesystem::remove(temporary_, ignored);
        open_ = false;
    }
    [[noreturn]] void fail(int reason) {
        discard();
        throw Error(Fault::could_not_finish,
                    "cannot write " + path_.string() + ": " + std::strerror(reason ? reason : EIO));
    }

    std::filesystem::path path_, target_, temporary_;
    std::ofstream stream_;
    bool in_place_ = false, open_ = false;
};

/// Writes the file through `body(std::ostream&)`, whole or not at all. Throws
/// Error(could_not_finish) if a byte could not be written.
template <class Body>
void write_atomically(const std::filesystem::path& path, const Body& body) {
    AtomicFile file(path);
    body(file.stream());
    file.commit();
}

/// Throws Error(could_not_finish) if `path` could not be written now: to be asked before long work.
inline void check_writable(const std::filesystem::path& path) {
    AtomicFile{path};
}

}  // namespace exitance
