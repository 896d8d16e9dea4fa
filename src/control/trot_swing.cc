#include "control/trot_swing.h"

#include <algorithm>

namespace gloam {
namespace {

/// Minimum-jerk step from 0 to 1 over s in 0 … 1 (Flash and Hogan 1985), and its derivatives.
struct Blend {
  double x, dx, ddx;
};
Blend minimum_jerk(double s) {
  return {s * s * s * (10 + s * (-15 + 6 * s)), 30 * s * s * (1 - s) * (1 - s),
          60 * s * (1 - s) * (1 - 2 * s)};
}

}  // namespace

FootGoal swing_point(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double clearance,
                     double phase, double duration) {
  const double s = std::clamp(phase, 0.0, 1.0);
  const Blend all = minimum_jerk(s);
  FootGoal out;
  out.p = from + all.x * (to - from);
  out.v = all.dx / duration * (to - from);
  out.a = all.ddx / (duration * duration) * (to - from);
  const double top = std::max(from.z(), to.z()) + clearance;
  const bool rising = s < 0.5;
  const Blend half = minimum_jerk(rising ? 2 * s : 2 * s - 1);
  const double z0 = rising ? from.z() : top, z1 = rising ? top : to.z();
  out.p.z() = z0 + half.x * (z1 - z0);
  out.v.z() = half.dx * 2 / duration * (z1 - z0);
  out.a.z() = half.ddx * 4 / (duration * duration) * (z1 - z0);
  return out;
}

}  // namespace gloam
