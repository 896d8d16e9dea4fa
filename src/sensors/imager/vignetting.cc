#include "sensors/imager/vignetting.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/lens.h"

namespace gloam {

std::vector<float> vignetting(const VignettingOptions& options, const Intrinsics& k) {
  std::vector<float> factors(static_cast<size_t>(k.width) * static_cast<size_t>(k.height));
  const PixelRays rays(k);
  const double half_diagonal2 =
      0.25 * (double{1} * k.width * k.width + double{1} * k.height * k.height);
  const Vec3& p = options.polynomial;
  parallel_for_range("vignetting", k.height, 8, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < k.width; ++x) {
        const double u = x + 0.5, v = y + 0.5;
        double factor = 1;
        if (options.cos4) {
          const auto ray = rays.at(u, v);
          factor = ray ? std::pow(std::max(0.0, -ray->d_C.z), 4) : 0;
        }
        const double dx = u - 0.5 * k.width, dy = v - 0.5 * k.height;
        const double r2 = (dx * dx + dy * dy) / half_diagonal2;
        factor *= 1 + r2 * (p.x + r2 * (p.y + r2 * p.z));
        factors[static_cast<size_t>(y) * static_cast<size_t>(k.width) + static_cast<size_t>(x)] =
            static_cast<float>(std::max(0.0, factor));
      }
    }
  });
  return factors;
}

}  // namespace gloam
