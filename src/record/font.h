#pragma once
// A small stroke font of our own: printable ASCII as lines and quadratic B-splines on a grid, so it
// is smooth at every size.

#include <vector>

#include "base/vec.h"

namespace gloam {

inline constexpr float kFontCapHeight = 7;    ///< [grid units]
inline constexpr float kFontSpacing = 2.15f;  ///< between characters

struct Glyph {
  float width = 0;                        ///< without spacing
  std::vector<std::vector<Vec2f>> lines;  ///< x to the right, y up, base line at 0
};

/// '?' for characters that are not printable ASCII.
Glyph make_glyph(char c);

}  // namespace gloam
