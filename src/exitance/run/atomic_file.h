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

/// Writes through `body(std::ostream&)` to a temporary file beside `path`, then renames it.
/// Throws Error(could_not_finish) and leaves nothing behind if a byte could not be written.
template <class Body>
void write_atomically(const std::filesystem::path& path, const Body& body) {
    std::filesystem::path temporary = path;
    temporary += "." + std::to_string(::getpid()) + ".tmp";
    const auto fail = [&](int reason) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw Error(Fault::could_not_finish,
                    "cannot write " + path.string() + ": " + std::strerror(reason ? reason : EIO));
    };
    errno = 0;
    {
        std::ofstream file(temporary, std::ios::binary);
        if (!file) fail(errno);
        try {
            body(file);
        } catch (...) {
            file.close();
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throw;
        }
        file.close();
        if (!file) fail(errno);
    }
    std::error_code renamed;
    std::filesystem::rename(temporary, path, renamed);
    if (renamed) fail(renamed.value());
}

}  // namespace exitance
