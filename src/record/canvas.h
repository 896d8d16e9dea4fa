#pragma once
// Drawing for pictures that people look at: rectangles, smooth lines, text.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "render/film/color_map.h"

namespace gloam {

using Polyline = std::vector<Vec2f>;  ///< points [px]

enum class Align : uint8_t { kLeft, kCenter, kRight };

class Canvas {
 public:
  Canvas(int width, int height, Rgb8 background);

  void fill(int x, int y, int width, int height, Rgb8 color);
  /// `rgb`: (height x width x 3).
  void paste(int x, int y, int width, int height, std::span<const uint8_t> rgb);
  /// Lines with round ends, `width` px wide; where they cross they cover once.
  void stroke(std::span<const Polyline> lines, float width, Rgb8 color);
  /// One line of text; `y` is its base line, `size` the height of a capital [px]. What is not
  /// printable ASCII is drawn as '?'. Returns its width [px].
  float text(float x, float y, std::string_view text, float size, Rgb8 color,
             Align align = Align::kLeft, bool bold = false);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<uint8_t>& pixels() const { return pixels_; }

 private:
  int width_, height_;
  std::vector<uint8_t> pixels_;  // (height x width x 3)
};

/// Width of a text [px].
float text_width(std::string_view text, float size);

/// The text, cut with ".." at its end if it is wider than `width`.
std::string fit_text(std::string_view text, float size, float width);

}  // namespace gloam
