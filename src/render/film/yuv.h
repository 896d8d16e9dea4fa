#pragma once
// RGB to the planes that video codecs take.

#include <cstdint>
#include <span>
#include <vector>

namespace gloam {

/// 4:2:0 planes, ITU-R BT.709 matrix, limited range (luma 16..235, chroma 16..240). Sizes are even:
/// an odd last column or row of the picture is repeated.
struct Yuv420 {
  int width = 0, height = 0;
  std::vector<uint8_t> y;     ///< (height x width)
  std::vector<uint8_t> u, v;  ///< Cb, Cr, (height/2 x width/2)
};

/// `rgb`: (height x width x 3), rows from the top. Chroma is sited as H.264 assumes by default:
/// level with the left luma sample of each pair, between the rows (type 0).
void rgb_to_yuv420(int width, int height, std::span<const uint8_t> rgb, Yuv420* out);

}  // namespace gloam
