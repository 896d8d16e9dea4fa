#pragma once
// JPEG for the live view. Reader: geometry/image_file.h.

#include <cstdint>
#include <span>
#include <vector>

namespace gloam {

/// Baseline JPEG, 4:2:0. `rgb`: sRGB (height x width x 3); width, height <= 65500; quality 1..100.
std::vector<uint8_t> encode_jpeg(int width, int height, std::span<const uint8_t> rgb,
                                 int quality = 85);

}  // namespace gloam
