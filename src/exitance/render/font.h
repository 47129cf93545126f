// SPDX-License-Identifier: Apache-2.0
// The typeface of legends: DejaVu Sans, built into the program from the system's copy.
#pragma once

namespace exitance {

/// The bytes of a TrueType file.
const unsigned char* legend_font();

}  // namespace exitance
