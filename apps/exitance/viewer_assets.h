// SPDX-License-Identifier: Apache-2.0
// The files of the page, as the build of viewer/ left them.
#pragma once

#include <span>
#include <string_view>

namespace exitance::cli {

struct ViewerAsset {
    std::string_view name;     ///< "index.html", "viewer.js", "viewer.css"
    std::string_view type;     ///< media type
    std::string_view content;  ///< UTF-8
};

std::span<const ViewerAsset> viewer_assets();

}  // namespace exitance::cli
