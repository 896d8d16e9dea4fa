#include "render/film/tone_map.h"

#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "base/srgb.h"

namespace gloam {
namespace {

// Interleaved gradient noise, Jimenez 2014, "Next Generation Post Processing in Call of Duty":
// even in every neighbourhood, so it dithers nearly as well as blue noise without a table. 0..1.
float gradient_noise(int x, int y) {
  const float inner = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float outer = 52.9829189f * (inner - std::floor(inner));
  return outer - std::floor(outer);
}

float to_positive(float x) { return x > 0 ? min(x, 1e6f) : 0.0f; }  // also for NaN

}  // namespace

float max_luminance(float ev100) { return 1.2f * std::exp2(ev100); }

float tone_curve(float x) {
  constexpr float kHeadroom = 1 - kShoulder;
  return x <= kShoulder ? x : 1 - kHeadroom * std::exp((kShoulder - x) / kHeadroom);
}

void tone_map(const std::vector<Vec3f>& radiance, int width, int height,
              const ToneMapSettings& settings, std::vector<uint8_t>* rgb) {
  const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
  GLOAM_CHECK(radiance.size() == n, "the number of radiance values does not match the image size");
  rgb->resize(3 * n);
  const float scale = 1 / max_luminance(settings.ev100);
  parallel_for_range("tone_map", height, 16, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + x;
        const Vec3f light = radiance[i] * scale;
        Vec3f color{to_positive(light.x), to_positive(light.y), to_positive(light.z)};
        if (settings.neutral)
          color = {tone_curve(color.x), tone_curve(color.y), tone_curve(color.z)};
        const float threshold = settings.dither ? gradient_noise(x, y) : 0.5f;
        for (int c = 0; c < 3; ++c) {
          const float level = 255 * srgb_encode(clamp(color[c], 0, 1)) + threshold;
          (*rgb)[3 * i + static_cast<size_t>(c)] = static_cast<uint8_t>(min(level, 255.0f));
        }
      }
    }
  });
}

}  // namespace gloam
