#include "sensors/camera/sample_noise.h"

#include <algorithm>
#include <cmath>

namespace gloam {

double pixel_error(const Film& film) {
  constexpr int kBlock = 8;
  if (film.variance.size() != film.pixel_count() || film.radiance.size() != film.pixel_count())
    return 0;
  std::vector<double> errors;
  for (int y0 = 0; y0 < film.height; y0 += kBlock) {
    for (int x0 = 0; x0 < film.width; x0 += kBlock) {
      double light = 0, variance = 0;
      int pixels = 0;
      for (int y = y0; y < std::min(y0 + kBlock, film.height); ++y) {
        for (int x = x0; x < std::min(x0 + kBlock, film.width); ++x, ++pixels) {
          const auto i =
              static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
          light += static_cast<double>(luminance(film.radiance[i]));
          variance += static_cast<double>(luminance(film.variance[i]));
        }
      }
      if (light > 0) errors.push_back(std::sqrt(variance * pixels) / light);
    }
  }
  if (errors.empty()) return 0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

int samples_needed(const Film& film, int spp) {
  constexpr int kMaxSamples = 65536;
  const double error = pixel_error(film);
  if (!(error > kMaxDenoisableError)) return spp;
  const double wanted = spp * (error / kMaxDenoisableError) * (error / kMaxDenoisableError);
  int needed = 1;
  while (needed < kMaxSamples && needed < wanted) needed *= 2;
  return needed;
}

}  // namespace gloam
