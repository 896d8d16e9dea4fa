#include "world/sky/environment.h"

#include <cmath>

#include "base/parallel.h"

namespace gloam {

float illuminance(const EnvironmentDescription& e, Vec3f n) {
  std::vector<double> rows(static_cast<size_t>(e.height));
  std::vector<double> along(static_cast<size_t>(e.width));  // n, level, along each column
  for (size_t column = 0; column < along.size(); ++column) {
    const double azimuth = M_PI * (1 - 2 * (static_cast<double>(column) + 0.5) / e.width);
    along[column] = n.x * std::cos(azimuth) + n.y * std::sin(azimuth);
  }
  parallel_for("sky illuminance", e.height, [&](int64_t row) {
    const double polar = M_PI * (static_cast<double>(row) + 0.5) / e.height;
    const double sine = std::sin(polar), z = std::cos(polar);
    double sum = 0;
    const Vec3f* texels = &e.texels[static_cast<size_t>(row) * along.size()];
    for (size_t column = 0; column < along.size(); ++column) {
      const double cosine = sine * along[column] + n.z * z;
      if (cosine > 0) sum += cosine * luminance(texels[column]);
    }
    const double zone = std::cos(M_PI * static_cast<double>(row) / e.height) -
                        std::cos(M_PI * static_cast<double>(row + 1) / e.height);
    rows[static_cast<size_t>(row)] = sum * zone * 2 * M_PI / e.width;
  });
  double sum = 0;
  for (const double row : rows) sum += row;
  return static_cast<float>(sum * e.scale);
}

float brightest_side(const EnvironmentDescription& environment) {
  float most = 0;
  for (const Vec3f n :
       {Vec3f{1, 0, 0}, Vec3f{-1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, -1, 0}, Vec3f{0, 0, 1}}) {
    most = max(most, illuminance(environment, n));
  }
  return most;
}

}  // namespace gloam
