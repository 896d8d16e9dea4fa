#pragma once
// Interface of the host to the kernels between a picture's samples and the host's memory.

#include "render/kernel/film/tone.h"

struct CUstream_st;

namespace gloam {

/// Planes of one picture of one world that is to be finished; pointers are the device's.
struct FinishPicture {
  int width = 0, height = 0, border = 0;
  // Of the film: the noisy light and its guides.
  const Vec3f *radiance = nullptr, *albedo = nullptr, *normal = nullptr;
  // Without fireflies, and of each what it gives to the pixels around; bits say where they are, in
  // rows of whole words.
  Vec3f *color = nullptr, *spread = nullptr;
  float* brightness = nullptr;
  uint32_t* flies = nullptr;
  Vec3f* light = nullptr;  ///< as the picture is to keep it
  // With a border, for the denoiser: its inputs and its output.
  Vec3f *wide_color = nullptr, *wide_albedo = nullptr, *wide_normal = nullptr, *clean = nullptr;
  // Sums over windows, first over those of rows: of the light that is wanted and of what is found.
  Vec3f *rows[2] = {}, *windows[2] = {};
  double* totals = nullptr;  ///< kTotalBlocks times that of `light` and that of `finished`
  Vec3f* gain = nullptr;     ///< one: of the whole picture
  Vec3f* finished = nullptr;

  static constexpr int kTotalBlocks = 256;

  GLOAM_HD int wide_width() const { return width + 2 * border; }
  GLOAM_HD int wide_height() const { return height + 2 * border; }
  GLOAM_HD int words() const { return (width + 31) / 32; }  ///< of a row in `flies`
  GLOAM_HD size_t wide_index(int x, int y) const {
    return static_cast<size_t>(y + border) * static_cast<size_t>(wide_width()) +
           static_cast<size_t>(x + border);
  }
};

namespace cuda {

using Stream = CUstream_st*;

/// As remove_fireflies() and add_border(): makes the inputs of the denoiser, and `light`.
void launch_prepare(const FinishPicture& picture, Stream stream);
/// As remove_border() and restore_light(): makes `finished` of `clean`.
void launch_restore(const FinishPicture& picture, Stream stream);
/// As tone_map(): width x height pixels of light to 8-bit sRGB.
void launch_tone_map(const Vec3f* light, int width, int height, float max_luminance,
                     const ToneMapSettings& settings, uint8_t* rgb, Stream stream);

}  // namespace cuda
}  // namespace gloam
