#include "world/lights/lamp_motion.h"

#include <cmath>

namespace gloam {

Affine3f moved(const LampMotion& motion, double time, const Affine3f& X_BL) {
  // Whole turns away first: the sine of a large angle loses digits.
  const auto angle_of = [&](double rate) {
    const double turns = rate * time + motion.phase;
    return 2 * M_PI * (turns - std::floor(turns));
  };
  const double angle = motion.swing > 0 ? motion.swing * std::sin(angle_of(motion.swing_rate))
                                        : angle_of(motion.turns);
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  const auto turn = [&](Vec3f v) {
    const Vec3f& a = motion.axis;
    return v * c + cross(a, v) * s + a * (dot(a, v) * (1 - c));
  };
  return {turn(X_BL.x), turn(X_BL.y), turn(X_BL.z), motion.pivot + turn(X_BL.p - motion.pivot)};
}

double pendulum_rate(double cord) {
  constexpr double kGravity = 9.81;  // [m/s²]
  return std::sqrt(kGravity / cord) / (2 * M_PI);
}

}  // namespace gloam
