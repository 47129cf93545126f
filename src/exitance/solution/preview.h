// SPDX-License-Identifier: Apache-2.0
// The colours that a glTF viewer shows: exitance of all groups, tone mapped once for the file.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "exitance/math/vector.h"

namespace exitance {

/// Global photographic operator (Reinhard, Stark, Shirley & Ferwerda 2002, eqs. 1, 2 and 4).
struct PreviewTone {
    double scale = 1;          ///< key 0.18 over the log-average luminance
    double white_squared = 1;  ///< scaled luminance that becomes white, squared

    /// Linear display value 0 … 1 per channel of linear RGB `value`.
    Vec3f operator()(const Vec3f& value) const;
};

/// Tone for surfaces whose vertices show `colours` [linear RGB]; `areas` are their weights.
PreviewTone preview_tone(std::span<const Vec3f> colours, std::span<const float> areas);

}  // namespace exitance
