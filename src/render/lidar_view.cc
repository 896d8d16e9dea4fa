#include "render/lidar_view.h"

#include <cmath>

namespace gloam {

LidarMotion make_lidar_motion(const Affine3f& X_WL_open, const Affine3f& X_WL_close) {
  LidarMotion motion;
  motion.X_WL = X_WL_open;
  motion.shift = X_WL_close.p - X_WL_open.p;
  // Rotation from open to close, in the frame at open: twice its sine times the axis is what its
  // matrix R lacks to be symmetric.
  const Affine3f& a = X_WL_open;
  const Affine3f& b = X_WL_close;
  const auto in_open = [&a](Vec3f v) { return Vec3f{dot(v, a.x), dot(v, a.y), dot(v, a.z)}; };
  const Vec3f x = in_open(b.x), y = in_open(b.y), z = in_open(b.z);
  const Vec3f sine2{y.z - z.y, z.x - x.z, x.y - y.x};
  const double s = 0.5 * std::sqrt(static_cast<double>(length_squared(sine2)));
  const double c = 0.5 * (static_cast<double>(x.x) + y.y + z.z - 1);
  if (s < 1e-7) return motion;
  motion.axis = normalize(sine2);
  motion.turn = static_cast<float>(std::atan2(s, c) / (2 * M_PI));
  return motion;
}

std::array<Vec2f, kMostFootprintRays> footprint_points(int rays) {
  std::array<Vec2f, kMostFootprintRays> points;
  if (rays == 1) return points;
  for (int i = 0; i < rays; ++i) {
    // Within the radius r (in half angles at 1/e²) lies 1 - exp(-2 r²) of the power; turns by the
    // golden angle spread the points (Vogel 1979, "A better way to construct the sunflower head").
    const double fraction = (i + 0.5) / rays, r = std::sqrt(-0.5 * std::log(1 - fraction));
    const double angle = 2.399963229728653 * i;
    points[static_cast<size_t>(i)] = {static_cast<float>(r * std::cos(angle)),
                                      static_cast<float>(r * std::sin(angle))};
  }
  return points;
}

}  // namespace gloam
