#pragma once
// Readers of picture files that may come from strangers: sizes are checked before memory is asked
// for, damage is an Error, nothing leaks.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/image/image.h"
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

/// Radiance HDR ("RGBE"), three channels, plain or packed in either way; divided by the EXPOSURE of
/// its head. A texel is mantissa x 2^(exponent - 136). Errors: XYZE, rows that are not left to
/// right, damaged. Source: Ward, "Real Pixels", Graphics Gems II, 1991, and Radiance's filefmts.
Result<ImageF> decode_hdr(std::span<const uint8_t> bytes, const std::string& name,
                          uint64_t max_pixels = kMaxImagePixels);

/// Content of a KTX 1 file: one picture, or the six of a cube in the order +x -x +y -y +z -z.
/// Pictures of bytes are in `faces`, those of floats in `float_faces`.
struct KtxImage {
  std::vector<Image8> faces;
  std::vector<ImageF> float_faces;
};
/// The largest level of a 2-D or cube KTX 1 file (Khronos, "KTX File Format Specification" 1) of 8
/// bits (linear or sRGB), 16 or 32-bit floats, or R11F_G11F_B10F, which Filament's cmgen writes for
/// MuJoCo's image lights. Errors: compressed, arrays, 1-D, 3-D, damaged.
Result<KtxImage> decode_ktx(std::span<const uint8_t> bytes, const std::string& name,
                            uint64_t max_pixels = kMaxImagePixels);

/// HDR or EXR by the first bytes: R, G, B, and A if there is one; a single grey channel is kept.
/// Errors: neither, damaged.
Result<ImageF> decode_float_image(std::span<const uint8_t> bytes, const std::string& name,
                                  uint64_t max_pixels = kMaxImagePixels);

/// PNG or JPEG by its first bytes, not by the name of the file.
Result<Image8> read_image(const std::filesystem::path& path);
/// The same for HDR and EXR.
Result<ImageF> read_float_image(const std::filesystem::path& path,
                                uint64_t max_pixels = kMaxImagePixels);

}  // namespace gloam
