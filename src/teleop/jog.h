#pragma once
// Moves the goal pose of a frame by hand.

#include "gloam/types.h"
#include "teleop/inputs.h"

namespace gloam::teleop {

/// Largest distance between the goal and the frame [m], [rad]: a goal out of reach must not run
/// away.
inline constexpr double kJogReach = 0.1, kJogTurn = 0.5;
/// A goal that is this many times farther away was set by another client.
inline constexpr double kForeign = 1.5;

/// A step of the goal: distance and angle at a deflection of 1 [m], [rad].
struct JogStep {
  double distance = 0, angle = 0;
};
/// Step of one key press at a speed of 1 … 9: 2 mm and 0.01 rad times the speed.
JogStep key_step(int speed);
/// Step of a stick during `seconds`: 0.02 m/s and 0.1 rad/s times the speed.
JogStep stick_step(int speed, double seconds);

/// Returns `X_WG`, the goal so far, moved by a step along and about the axes of a vertical frame
/// with heading `yaw` [rad]. `X_WF`: the frame's present pose; the goal stays within its reach.
Pose jogged(const Pose& X_WG, const Pose& X_WF, double yaw, const Deflection& move,
            const JogStep& step);

/// Angle about the vertical by which the x axis of a pose is turned from that of the world [rad].
double heading(const Pose& X_WB);

}  // namespace gloam::teleop
