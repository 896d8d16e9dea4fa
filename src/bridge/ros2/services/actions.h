#pragma once
// The actions that the node offers: SimulateSteps, and FollowJointTrajectory of each robot whose
// joints a controller brings to goals.

#include <string>
#include <vector>

#include "bridge/operations/operator.h"
#include "bridge/ros2/ros2_action.h"

namespace gloam::bridge {

/// NS/simulate_steps.
Ros2Action simulate_steps_action(Operator& operations, const std::string& ns, Ros2Publish publish);

/// Names of the robots that hear joint_trajectory: those to make actions for; after a recompile
/// others.
std::vector<std::string> trajectory_robots(Simulation& simulation);
/// /ROBOT/follow_joint_trajectory. `interfaces` 1: the feedback of control_msgs before 6.3.
Ros2Action trajectory_action(Simulation& simulation, const std::string& robot, int interfaces,
                             Ros2Publish publish);

}  // namespace gloam::bridge
