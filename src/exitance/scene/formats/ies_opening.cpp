// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/ies_opening.h"

#include <cmath>

namespace exitance {

namespace {

using Shape = LuminousOpening::Shape;

LuminousOpening body(Shape shape, const Vec3& size, std::uint32_t axis = 2) {
    LuminousOpening out;
    out.shape = shape;
    out.size = size;
    out.axis = axis;
    return out;
}

}  // namespace

// Signs, as width length height (− rounded, 0 not given), mean in LM-63:
//     1986 to 1995                         since 2002
//     − 0 0  disc                          − − 0  disc, ellipse
//     − 0 +  upright cylinder              − − +  upright cylinder
//     − 0 −  sphere                        − − −  sphere, ellipsoid;  − 0 −  upright disc
//     0 + −  cylinder along the length     − + −  cylinder along the length
//     + 0 −  cylinder along the width      + − −  cylinder along the width
//     − + +, + − +  ellipse;  − + −, + − −  ellipsoid
// Files name the wrong edition now and then, so only the two patterns in conflict ask for it.
LuminousOpening ies_opening(double width, double length, double height, IesEdition edition) {
    const bool recent = edition >= IesEdition::y2002;
    const double w = std::abs(width), l = std::abs(length), h = std::abs(height);
    const bool round_w = width < 0, round_l = length < 0, round_h = height < 0;
    if (w == 0 && l == 0 && h == 0) return {};
    if (!round_w && !round_l && !round_h) return body(Shape::box, {l, w, h});
    if (round_w && l == 0) {
        if (!round_h) return body(Shape::cylinder, {w, w, h});
        if (recent) return body(Shape::cylinder, {0, w, h}, 0);
        return body(Shape::ellipsoid, {w, w, h});
    }
    if (!round_w && !round_l) {  // round in height only
        if (w == 0) return body(Shape::cylinder, {l, h, h}, 0);
        if (l == 0) return body(Shape::cylinder, {h, w, h}, 1);
        return body(Shape::box, {l, w, h});
    }
    if (round_w && round_l) return body(round_h ? Shape::ellipsoid : Shape::cylinder, {l, w, h});
    if (!round_h) return body(Shape::cylinder, {l == 0 ? w : l, w == 0 ? l : w, h});
    if (!recent) return body(Shape::ellipsoid, {l, w == 0 ? l : w, h});
    return body(Shape::cylinder, {l, w, h}, round_w ? 0 : 1);
}

}  // namespace exitance
