#pragma once
// Turns and swings of a lamp: a pure function of simulation time.

#include "base/vec.h"

namespace gloam {

/// About an axis through a point that are fixed to the lamp's body: steady turns, and a sine.
struct LampMotion {
  Vec3f axis{0, 0, 1};    ///< unit
  Vec3f pivot;            ///< [m]
  double turns = 0;       ///< [1/s], counter-clockwise seen against the axis
  double swing = 0;       ///< amplitude [rad]
  double swing_rate = 0;  ///< [Hz]
  double phase = 0;       ///< fraction of a turn or swing that is over at time 0
};

/// Pose in its body at `time` [s] of a lamp that rests at X_BL.
Affine3f moved(const LampMotion& motion, double time, const Affine3f& X_BL);

/// Swings in a second of a hanging lamp, `cord` [m] below where it hangs: small swings of a point
/// mass on earth.
double pendulum_rate(double cord);

}  // namespace gloam
