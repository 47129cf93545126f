// SPDX-License-Identifier: Apache-2.0
// A file that stays readable when its name is gone.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace exitance::cli {

class OpenFile {
  public:
    /// Throws Error(could_not_finish) if it cannot be opened.
    explicit OpenFile(const std::filesystem::path& path);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    std::size_t size() const { return size_; }
    /// Leads to the file even when its own name is gone.
    std::filesystem::path path() const;
    /// Fills `block` from `offset` on; how many bytes could be had.
    std::size_t read(std::size_t offset, std::span<char> block) const;
    /// All of it. Throws Error(could_not_finish).
    std::vector<char> content() const;

  private:
    int descriptor_;
    std::size_t size_ = 0;
};

}  // namespace exitance::cli
