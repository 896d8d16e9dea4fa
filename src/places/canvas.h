#pragma once
// Small drawings for labels and signs: filled shapes on a plain ground.

#include "geometry/image/image.h"
#include "geometry/solid.h"
#include "gloam/types.h"

namespace gloam {

/// x runs to the right from 0 to width / height, y up from 0 to 1. Colours are display (sRGB).
class Canvas {
 public:
  Canvas(int width, int height, Vec3 color);

  Canvas& fill(const Profile& outline, Vec3 color);  ///< by the even-odd rule
  Canvas& rectangle(Vec2f low, Vec2f high, Vec3 color);
  Canvas& disc(Vec2f center, float radius, Vec3 color);
  Canvas& line(Vec2f from, Vec2f to, float width, Vec3 color);  ///< its ends are round
  /// Bars of a bar code, or a line of print when `print`: which ones is a function of the seed.
  Canvas& bars(Vec2f low, Vec2f high, uint64_t seed, Vec3 color, bool print = false);

  const Image8& image() const { return image_; }

 private:
  void put(int x, int y, Vec3 color, float share);

  Image8 image_;
};

}  // namespace gloam
