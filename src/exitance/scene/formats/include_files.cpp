// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/include_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace fs = std::filesystem;

namespace {

fs::path real_path(const fs::path& path) {
    std::error_code failure;
    fs::path out = fs::weakly_canonical(fs::absolute(path, failure), failure);
    return failure ? path.lexically_normal() : out;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
    const auto [end, ignored] =
        std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return end == folder.end();
}

}  // namespace

bool leads_into(const fs::path& path, const fs::path& folder) {
    return lies_in(real_path(path), real_path(folder.empty() ? fs::path(".") : folder));
}

IncludeFiles::IncludeFiles(const fs::path& root, std::string text, const ReadOptions& options)
    : options_(options), folder_(real_path(root).parent_path()) {
    open_.push_back(std::make_shared<SourceFile>(SourceFile{root, std::move(text)}));
    known_.emplace(real_path(root), open_.back());
}

fs::path IncludeFiles::resolve(const std::string& name, const Place& named) const {
    if (name.find('\0') != std::string::npos)
        throw Error(named, fmt::format("found {}, expected the name of a file", in_quotes(name)));
    const fs::path given(name);
    const bool first = open_.size() == 1 && !options_.held_in;
    const fs::path path = given.is_absolute() ? given : current()->path.parent_path() / given;
    if ((given.is_absolute() && first) || lies_in(real_path(path), folder_)) return path;
    throw Error(named, fmt::format("found {}, expected a file inside the scene's folder{}",
                                   in_quotes(name), first ? " or its absolute path" : ""));
}

std::shared_ptr<const SourceFile> IncludeFiles::enter(const std::string& name, const Place& named) {
    const fs::path path = resolve(name, named);
    const fs::path key = real_path(path);
    if (open_.size() >= options_.max_include_depth)
        throw Error(named, fmt::format("files include each other more than {} deep; "
                                       "--max-include-depth raises the limit",
                                       options_.max_include_depth));
    if (++entered_ > options_.max_files)
        throw Error(named, fmt::format("more than {} files are included; --max-files raises the "
                                       "limit",
                                       options_.max_files));
    auto& file = known_[key];
    if (!file) {
        try {
            file = std::make_shared<SourceFile>(
                SourceFile{path, read_whole_file(path, options_.most_bytes())});
        } catch (const Error& error) {
            throw Error(named, fmt::format("{} cannot be read: {}", in_quotes(name), error.what()));
        }
    }
    if (std::find(open_.begin(), open_.end(), file) != open_.end())
        throw Error(named, fmt::format("the file includes itself: {}", in_quotes(name)));
    open_.push_back(file);
    return file;
}

}  // namespace exitance
