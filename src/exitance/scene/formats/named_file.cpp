// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/named_file.h"

#include "exitance/scene/formats/include_files.h"

namespace exitance {

std::filesystem::path named_file(const TomlTable& table, const std::string& key,
                                 const std::filesystem::path& folder, const ReadOptions& options) {
    const std::filesystem::path file = (folder / *table.text(key)).lexically_normal();
    if (options.held_in && !leads_into(file, *options.held_in))
        table.refuse(key, "a file inside the folder of the first project, as it names this one");
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        table.refuse(key, "a file; there is none at " + file.string());
    return file;
}

}  // namespace exitance
