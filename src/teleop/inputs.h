#pragma once
// Inputs of a user, independent of the device.

#include <chrono>

namespace gloam::teleop {

using Clock = std::chrono::steady_clock;
using Time = Clock::time_point;

/// How far a robot shall move along each axis of its heading frame: -1 … 1 of the selected speed.
struct Deflection {
  double forward = 0, left = 0, up = 0;
  double turn = 0;             ///< counterclockwise, seen from above
  double roll = 0, pitch = 0;  ///< about the forward and the left axis; pose goals only
  bool operator==(const Deflection&) const = default;
  bool is_zero() const { return *this == Deflection{}; }
};
inline constexpr double Deflection::* kAxes[] = {&Deflection::forward, &Deflection::left,
                                                 &Deflection::up,      &Deflection::turn,
                                                 &Deflection::roll,    &Deflection::pitch};

inline constexpr int kSlowest = 1, kFastest = 9, kUsualSpeed = 5;

enum class Request {
  kNone,
  kStop,
  kGripper,  ///< opens or closes it
  kGripperOpen,
  kGripperClose,
  kSwitchGoal,  ///< between velocity and pose goals
  kFaster,
  kSlower,
  kHelp,
  kEnd,
};

}  // namespace gloam::teleop
