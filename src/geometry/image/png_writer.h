#pragma once
// PNG files in memory. Fast settings: a recorder writes thousands of them. Readers:
// geometry/image/image_file.h.

#include <cstdint>
#include <span>
#include <vector>

namespace gloam {

/// 8 bits per channel; 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) channels, tagged sRGB.
/// `pixels`: (height x width x channels).
std::vector<uint8_t> encode_png8(int width, int height, int channels,
                                 std::span<const uint8_t> pixels);

/// 16-bit grey. `pixels`: (height x width).
std::vector<uint8_t> encode_png16(int width, int height, std::span<const uint16_t> pixels);

}  // namespace gloam
