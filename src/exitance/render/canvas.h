// SPDX-License-Identifier: Apache-2.0
// Lines, boxes and text on a picture, anti-aliased.
#pragma once

#include <string>

#include "exitance/render/image.h"

namespace exitance {

/// Draws on an image of linear display values; places are pixels from the top left corner.
class Canvas {
  public:
    explicit Canvas(Image& image) : image_(image) {}

    void fill(double left, double top, double right, double bottom, const Vec3f& colour,
              double opacity = 1);
    void line(double x0, double y0, double x1, double y1, double width, const Vec3f& colour,
              double opacity = 1);
    /// UTF-8 text whose baseline starts at (x, y); `size` is the height from the top of an
    /// ascender to the bottom of a descender.
    void text(double x, double y, double size, const std::string& text, const Vec3f& colour);
    /// Width of a text [pixels].
    static double text_width(const std::string& text, double size);
    /// Height of a capital letter or digit [pixels].
    static double digit_height(double size) { return 0.626 * size; }

  private:
    Image& image_;
    void blend(std::int64_t x, std::int64_t y, const Vec3f& colour, double opacity);
};

}  // namespace exitance
