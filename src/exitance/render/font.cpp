// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/font.h"

// EXITANCE_FONT: path of DejaVuSans.ttf, from CMake.
asm(".pushsection .rodata\n"
    ".balign 16\n"
    "exitance_legend_font:\n"
    ".incbin \"" EXITANCE_FONT
    "\"\n"
    ".popsection\n");

extern const unsigned char font_bytes[] asm("exitance_legend_font");

namespace exitance {

const unsigned char* legend_font() {
    return font_bytes;
}

}  // namespace exitance
