// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/lamp_file.h"

#include "exitance/scene/formats/eulumdat.h"
#include "exitance/scene/formats/ies.h"
#include "exitance/scene/formats/lamp_doubts.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

bool is_lamp_file(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    return extension == ".ies" || extension == ".ldt";
}

LampFile read_lamp_file(const std::filesystem::path& path, std::uint32_t lamp_set,
                        const ReadOptions& options) {
    const auto whole = [&](const std::filesystem::path& file) {
        return read_whole_file(file, options.most_bytes());
    };
    const std::string extension = lower_extension(path);
    const auto with_doubts = [&](LampFile lamp) {
        for (Problem& doubt : doubts(lamp.photometry, {path.string(), 0, 0}))
            lamp.warnings.push_back(std::move(doubt));
        return lamp;
    };
    if (extension == ".ldt")
        return with_doubts(parse_eulumdat(path.string(), whole(path), lamp_set));
    if (extension != ".ies")
        throw Error({path.string(), 0, 0},
                    "not a photometric file, expected IES LM-63 (.ies) or EULUMDAT (.ldt)");
    if (lamp_set != 1) throw Error({path.string(), 0, 0}, "an IES file has one set of lamps only");
    return with_doubts(parse_ies(path.string(), whole(path), [&](const std::string& name) {
        const std::filesystem::path beside = path.parent_path() / name;
        return TiltFile{beside.string(), whole(beside)};
    }));
}

}  // namespace exitance
