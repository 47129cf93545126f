// SPDX-License-Identifier: Apache-2.0
#include "open_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "exitance/run/error.h"

namespace exitance::cli {

OpenFile::OpenFile(const std::filesystem::path& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat facts {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &facts) != 0)
        throw Error(Fault::could_not_finish,
                    "cannot read " + path.string() + ": " + std::strerror(errno));
    size_ = static_cast<std::size_t>(facts.st_size);
}

OpenFile::~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::filesystem::path OpenFile::path() const {
    return fmt::format("/proc/self/fd/{}", descriptor_);
}

std::size_t OpenFile::read(std::size_t offset, std::span<char> block) const {
    std::size_t filled = 0;
    while (filled < block.size()) {
        const ssize_t got = ::pread(descriptor_, block.data() + filled, block.size() - filled,
                                    static_cast<off_t>(offset + filled));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        filled += static_cast<std::size_t>(got);
    }
    return filled;
}

std::vector<char> OpenFile::content() const {
    std::vector<char> out(size_);
    if (read(0, out) < size_)
        throw Error(Fault::could_not_finish, "the solution cannot be read to its end");
    return out;
}

}  // namespace exitance::cli
