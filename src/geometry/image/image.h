#pragma once
// Images in memory, rows from the top.

#include <cstdint>
#include <vector>

namespace gloam {

enum class ColorSpace : uint8_t { kLinear, kSrgb };

/// Continuation of a texture beyond its edges.
enum class TextureWrap : uint8_t { kRepeat, kMirror, kClamp };

/// 8-bit texels of a texture.
struct Image8 {
  int width = 0, height = 0, channels = 0;
  ColorSpace color_space = ColorSpace::kSrgb;
  std::vector<uint8_t> texels;  ///< (height x width x channels)
};

/// Float texels, linear Rec. 709, as environment maps have them.
struct ImageF {
  int width = 0, height = 0, channels = 0;
  std::vector<float> texels;  ///< (height x width x channels)
};

}  // namespace gloam
