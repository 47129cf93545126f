// SPDX-License-Identifier: Apache-2.0
// The luminous opening of an IES file, whose shape is told by the signs of its sizes.
#pragma once

#include "exitance/scene/luminous_opening.h"

namespace exitance {

/// Year of an LM-63 edition.
enum class IesEdition { y1986 = 1986, y1991 = 1991, y1995 = 1995, y2002 = 2002, y2019 = 2019 };

/// `width` is along C90, `length` along C0, `height` upright [m], with the signs of the file.
LuminousOpening ies_opening(double width, double length, double height, IesEdition edition);

}  // namespace exitance
