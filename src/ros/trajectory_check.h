#pragma once
// Trajectories of joints from messages, by the rules of ros2_controllers'
// joint_trajectory_controller, for the action and for topics.

#include <cstdint>
#include <span>
#include <string>

#include "gloam/joints/joint_trajectory.h"
#include "gloam/result.h"
#include "ros/messages/trajectory_msgs.h"

namespace gloam {

/// Errors: no names, an empty one, one that is there twice.
Status check_joint_names(std::span<const std::string> names);
/// Efforts are checked but not used. Errors: those of JointPath::make(); efforts that are neither
/// none nor one for each joint, or not finite.
Result<JointTrajectory> joint_trajectory_of(const trajectory_msgs::JointTrajectory& message);
/// The step at which a message's trajectory starts: that of its stamp, or the next one if the stamp
/// is 0 or past. `now`: simulation time; steps take `timestep` [s]. Errors: it has a stamp and ends
/// before `now`; it starts more than a day later, because the stamp is of another clock.
Result<int64_t> start_step(const trajectory_msgs::JointTrajectory& message, double now,
                           double timestep);

}  // namespace gloam
