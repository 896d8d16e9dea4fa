#pragma once
// Colour filters before single pixels, and the picture that is guessed from them.

#include <string>
#include <vector>

#include "base/vec.h"

namespace gloam {

/// Colour that each pixel sees (Bayer, US patent 3971065). Places repeat every 2 x 2 pixels.
class Mosaic {
 public:
  /// "rggb", "bggr", "grbg", "gbrg": the top left 2 x 2 by rows.
  explicit Mosaic(const std::string& name);
  /// 0 red, 1 green, 2 blue.
  int color(int x, int y) const { return colors_[(y & 1) * 2 + (x & 1)]; }

 private:
  int colors_[4];
};

/// Colours from a mosaic by the 5 x 5 linear filters of Malvar, He and Cutler 2004, "High-quality
/// linear interpolation for demosaicing of Bayer-patterned color images". values (height x width),
/// out likewise; at the borders pixels are mirrored. Linear: scales and means are kept.
void demosaic(const Mosaic& mosaic, const std::vector<float>& values, int width, int height,
              std::vector<Vec3f>* out);

}  // namespace gloam
