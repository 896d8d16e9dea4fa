// One beam through two prisms that turn at different speeds (Risley): a rosette that does not
// repeat from scan to scan and fills the field of view the longer it looks. Thin prisms: each bends
// the beam by a quarter of the field of view, and what they do adds up (to first order; Brazeal,
// Wilkinson and Hochmair 2021, "A rigorous observation model for the Risley prism-based Livox
// Mid-40 lidar sensor").

#include <cmath>

#include "sensors/lidar/lidar_pattern.h"

namespace gloam {

std::vector<LidarFiring> fire_rosette(const LidarModel& model, int64_t scan) {
  std::vector<LidarFiring> firings(static_cast<size_t>(model.points));
  const double period = 1 / model.rate.value();
  const auto angle_of = [&](int prism, double t) {
    const double turns = model.prism_hz[prism] * t;
    return 2 * M_PI * (turns - std::floor(turns));  // exact for long times
  };
  for (int i = 0; i < model.points; ++i) {
    const double share = static_cast<double>(i) / model.points;
    const double t = (static_cast<double>(scan) + share) * period;
    const double a = angle_of(0, t), b = angle_of(1, t);
    const double left = 0.25 * model.width * (std::cos(a) + std::cos(b));
    const double up = 0.25 * model.height * (std::sin(a) + std::sin(b));
    const double bend = std::hypot(left, up), sine = bend > 0 ? std::sin(bend) / bend : 1;
    LidarFiring& firing = firings[static_cast<size_t>(i)];
    firing.d = {static_cast<float>(std::cos(bend)), static_cast<float>(left * sine),
                static_cast<float>(up * sine)};
    firing.time = static_cast<float>(share);
  }
  return firings;
}

}  // namespace gloam
