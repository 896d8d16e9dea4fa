#include "render/film/tone_map.h"

#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace gloam {

float max_luminance(float ev100) { return 1.2f * std::exp2(ev100); }

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
        tone_map_pixel(radiance[i] * scale, x, y, settings, rgb->data() + 3 * i);
      }
    }
  });
}

}  // namespace gloam
