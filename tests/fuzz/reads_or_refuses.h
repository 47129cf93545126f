// SPDX-License-Identifier: Apache-2.0
// What every reader owes to any bytes: a scene that can be mended and checked, or an Error that
// names the file.
#pragma once

#include <cstdlib>
#include <string_view>

#include "exitance/run/error.h"
#include "exitance/scene/mend.h"
#include "exitance/scene/validate.h"

namespace exitance::fuzz {

/// `read()` returns a Scene read from a file called `name`.
template <class Read>
int reads_or_refuses(std::string_view name, const Read& read) {
    try {
        Scene scene = read();
        mend(scene);
        validate(scene);
    } catch (const Error& error) {
        if (error.exit_code() != 3 || std::string_view(error.what()).substr(0, name.size()) != name)
            std::abort();
    }
    return 0;
}

}  // namespace exitance::fuzz
