// SPDX-License-Identifier: Apache-2.0
// Files that a scene file names: looked up beside the file that names them, inside the folder of
// the first file, in finite numbers.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exitance/run/error.h"
#include "exitance/scene/read_options.h"

namespace exitance {

struct SourceFile {
    std::filesystem::path path;
    std::string text;
};

/// Does `path` lead into `folder` or a folder below it, links followed?
bool leads_into(const std::filesystem::path& path, const std::filesystem::path& folder);

class IncludeFiles {
  public:
    /// `root` has been read already: `text`. Limits are those of `options`.
    IncludeFiles(const std::filesystem::path& root, std::string text, const ReadOptions& options);

    /// The file opened last and not left.
    std::shared_ptr<const SourceFile> current() const { return open_.back(); }
    /// Where a name in the current file leads to. Throws Error at `named` for a path that leaves
    /// the folder of the root, unless the root itself names it absolutely and is the user's own
    /// file (ReadOptions::held_in).
    std::filesystem::path resolve(const std::string& name, const Place& named) const;
    /// Opens the file `name`; its text is read once. Throws Error at `named` if it cannot be read,
    /// is open already, or if a limit is exceeded.
    std::shared_ptr<const SourceFile> enter(const std::string& name, const Place& named);
    void leave() { open_.pop_back(); }

  private:
    const ReadOptions& options_;
    std::filesystem::path folder_;  // canonical
    std::vector<std::shared_ptr<const SourceFile>> open_;
    std::map<std::filesystem::path, std::shared_ptr<const SourceFile>> known_;  // by canonical path
    std::uint64_t entered_ = 0;
};

}  // namespace exitance
