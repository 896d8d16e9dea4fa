#pragma once
// Velocity goals from deflections.

#include "gloam/command.h"
#include "gloam/drive/robot_goals.h"
#include "teleop/inputs.h"

namespace gloam::teleop {

/// Goal for a deflection at a speed of 1 … 9, as a fraction speed / 9 of the ranges; axes without a
/// limit: 1 m/s, 0.5 m/s sideways, 1 rad/s. A robot that cannot move sideways turns instead.
/// Deflections are rounded to 1/50, so that the noise of a stick does not change the goal.
SetVelocityGoal velocity_goal(Robot robot, const VelocityRanges& ranges, Deflection move,
                              int speed);

bool is_same(const SetVelocityGoal& a, const SetVelocityGoal& b);
inline bool is_standing(const SetVelocityGoal& goal) {
  return is_same(goal, {.robot = goal.robot});
}

}  // namespace gloam::teleop
