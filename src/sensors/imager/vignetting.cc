#include "sensors/imager/vignetting.h"

#include <algorithm>

namespace gloam {

float vignetting(const VignettingOptions& options, const Intrinsics& k, int x, int y) {
  const double u = x + 0.5, v = y + 0.5;
  double factor = 1;
  if (options.cos4 && !k.orthographic) {
    const double a = (u - k.cx) / k.fx, b = (v - k.cy) / k.fy;
    const double cos2 = 1 / (1 + a * a + b * b);
    factor = cos2 * cos2;
  }
  const double dx = u - 0.5 * k.width, dy = v - 0.5 * k.height;
  const double half_diagonal2 =
      0.25 * (static_cast<double>(k.width) * k.width + static_cast<double>(k.height) * k.height);
  const double r2 = (dx * dx + dy * dy) / half_diagonal2;
  const Vec3& p = options.polynomial;
  factor *= 1 + r2 * (p.x + r2 * (p.y + r2 * p.z));
  return static_cast<float>(std::max(0.0, factor));
}

}  // namespace gloam
