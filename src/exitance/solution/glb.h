// SPDX-License-Identifier: Apache-2.0
// The container of binary glTF 2.0 (Khronos specification, section 4.4): a JSON and a BIN chunk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace exitance {

struct GlbChunks {
    std::string json;
    std::vector<std::byte> binary;
};

enum class GlbContent { all, json_only };

/// Reads the chunks of the file. Never allocates more than the file holds. Throws Error(bad_input)
/// that says what was found and what was expected.
GlbChunks read_glb(const std::filesystem::path& path, GlbContent content = GlbContent::all);

/// Writes header, `json`, and the BIN chunk of `binary_bytes` bytes that `write_binary` produces.
/// Throws Error(could_not_finish) where the 32-bit lengths of the format do not suffice.
void write_glb(std::ostream& out, std::string json, std::uint64_t binary_bytes,
               const std::function<void(std::ostream&)>& write_binary);

}  // namespace exitance
