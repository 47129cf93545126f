// SPDX-License-Identifier: Apache-2.0
// A folder that is gone when it is no longer needed.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "exitance/run/error.h"

namespace exitance::cli {

/// Readable by nobody else. Throws Error(could_not_finish) if it cannot be made.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::error_code failure;
        std::string name =
            (std::filesystem::temp_directory_path(failure) / "exitance-XXXXXX").string();
        if (failure || !::mkdtemp(name.data()))
            throw Error(Fault::could_not_finish, "cannot make the folder " + name);
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace exitance::cli
