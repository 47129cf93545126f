// SPDX-License-Identifier: Apache-2.0
#include "output_path.h"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/run/atomic_file.h"
#include "exitance/run/error.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/solution/file.h"

namespace exitance::cli {

void require_output(const std::filesystem::path& output, const std::filesystem::path& input,
                    const std::vector<std::string>& endings, const std::string& option) {
    std::error_code absent;
    const bool device = std::filesystem::is_other(output, absent);
    const std::string ending = lower_extension(output);
    if (!device && !endings.empty() &&
        std::find(endings.begin(), endings.end(), ending) == endings.end())
        throw Error(Fault::wrong_use,
                    fmt::format("{}: '{}' is not allowed, expected a name that ends in {}", option,
                                output.string(), fmt::join(endings, " or ")));
    if (std::filesystem::equivalent(output, input, absent))
        throw Error(Fault::wrong_use,
                    fmt::format("{}: '{}' would replace the input", option, output.string()));
    check_writable(output);
}

void require_scene(const std::filesystem::path& input) {
    if (is_solution(input))
        throw Error(Fault::wrong_use,
                    "'" + input.string() + "' is a solution already, expected a scene");
}

}  // namespace exitance::cli
