#pragma once
// Messages of input topics made of the Commands that applied: the reverse of input_topics.cc, so
// that a log has them whether they came in as messages or not.

#include <string>
#include <vector>

#include "topics/topic.h"

namespace gloam {

/// JointState with the targets that were set, NaN where a joint got another kind only; `ids` and
/// `names` are those of the robot's hinges and slides.
InputEcho joint_command_echo(int robot, std::vector<int> ids, std::vector<std::string> names);
/// Twist of the last velocity goal.
InputEcho velocity_echo(int robot);
/// PoseStamped of the last pose goal.
InputEcho pose_goal_echo(int robot);
/// Float64MultiArray of all controls of a robot, if one of them was set; `places` in mjData::ctrl.
InputEcho controls_echo(std::vector<int> places);
/// PoseWithCovarianceStamped of a free joint that was put elsewhere.
InputEcho initial_pose_echo(int joint);
/// WrenchStamped on a body.
InputEcho wrench_echo(int body);
/// PoseStamped of a mocap body.
InputEcho mocap_pose_echo(int body);
/// Empty, of a reset.
InputEcho reset_echo();

}  // namespace gloam
