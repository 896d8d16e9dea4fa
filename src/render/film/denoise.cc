#include "render/film/denoise.h"

#include <algorithm>

#include "base/check.h"
#include "base/log.h"
#include "base/parallel.h"

namespace gloam {
namespace {

constexpr float kFireflyRatio = 4;
constexpr int kRadius = 2;

float sanitize(float x) { return x > 0 ? min(x, 1e9f) : 0.0f; }  // also for NaN

}  // namespace

void remove_fireflies(const Film& film, std::vector<Vec3f>* out) {
  const size_t n = film.pixel_count();
  GLOAM_CHECK(film.radiance.size() == n, "a film without radiance cannot be denoised");
  out->resize(n);
  std::vector<float> brightness(n);
  parallel_for_range("fireflies", film.height, 16, [&](int64_t begin, int64_t end) {
    for (size_t i = static_cast<size_t>(begin * film.width);
         i < static_cast<size_t>(end * film.width); ++i) {
      const Vec3f c = film.radiance[i];
      (*out)[i] = {sanitize(c.x), sanitize(c.y), sanitize(c.z)};
      brightness[i] = luminance((*out)[i]);
    }
  });
  parallel_for_range("fireflies", film.height, 16, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < film.width; ++x) {
        const size_t i = static_cast<size_t>(y) * static_cast<size_t>(film.width) + x;
        float first = 0, second = 0, third = 0;  // brightest neighbours
        for (int v = std::max(0, y - kRadius); v <= std::min(film.height - 1, y + kRadius); ++v) {
          for (int u = std::max(0, x - kRadius); u <= std::min(film.width - 1, x + kRadius); ++u) {
            if (u == x && v == y) continue;
            float b = brightness[static_cast<size_t>(v) * static_cast<size_t>(film.width) + u];
            if (b > first) std::swap(b, first);
            if (b > second) std::swap(b, second);
            if (b > third) third = b;
          }
        }
        // Among all-black neighbours there is nothing to compare with: the pixel stays.
        if (third > 0 && brightness[i] > kFireflyRatio * third)
          (*out)[i] *= kFireflyRatio * third / brightness[i];
      }
    }
  });
}

std::unique_ptr<Denoiser> make_denoiser(const DenoiseOptions& options) {
  if (options.use_oidn) {
    Result<std::unique_ptr<Denoiser>> oidn = make_oidn_denoiser(options.quality);
    if (oidn.ok()) return std::move(oidn).value();
    log_debug("{}; using Gloam's own filter", oidn.error().to_string());
  }
  return make_edge_denoiser();
}

}  // namespace gloam
