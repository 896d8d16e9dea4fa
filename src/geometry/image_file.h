#pragma once
// Readers of picture files that may come from strangers: sizes are checked before memory is asked
// for, damage is an Error, nothing leaks.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/image.h"
#include "gloam/result.h"

namespace gloam {

/// Pictures with more pixels than this are refused (8192 x 8192).
inline constexpr uint64_t kMaxImagePixels = uint64_t{1} << 26;

/// 16-bit single-channel picture, rows from the top.
struct Image16 {
  int width = 0, height = 0;
  std::vector<uint16_t> texels;  ///< (height x width)
};

/// PNG of any kind as 8 bits with 1 to 4 channels; palettes are expanded, 16 bits are reduced.
/// `name` is for messages.
Result<Image8> decode_png(std::span<const uint8_t> bytes, const std::string& name,
                          uint64_t max_pixels = kMaxImagePixels);
/// PNG that must be 16-bit grey: depth and segmentation.
Result<Image16> decode_png16(std::span<const uint8_t> bytes, const std::string& name,
                             uint64_t max_pixels = kMaxImagePixels);
/// JPEG as 1 (grey) or 3 (RGB) channels; CMYK is refused.
Result<Image8> decode_jpeg(std::span<const uint8_t> bytes, const std::string& name,
                           uint64_t max_pixels = kMaxImagePixels);

/// PNG or JPEG by its first bytes, not by the name of the file.
Result<Image8> read_image(const std::filesystem::path& path);

}  // namespace gloam
