// Feedback of a goal of FollowJointTrajectory.

#include <utility>

#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/trajectory_run.h"
#include "ros/codec.h"
#include "ros/messages/control_msgs_5.h"

namespace gloam::bridge {

void TrajectoryRun::tell(const Snapshot& now, const ActiveTrajectory& path, GoalContext& context) {
  namespace fjt = control_msgs::action;
  fjt::FollowJointTrajectory_Feedback feedback;
  feedback.header.stamp = ros_time_of(now.time());
  feedback.joint_names = names_;
  const auto time = ros_time_of(now.time() - path.start_time);
  for (auto* part : {&feedback.desired, &feedback.actual, &feedback.error})
    part->time_from_start = {time.sec, time.nanosec};
  for (size_t i = 0; i < joints_.size(); ++i) {
    const JointState state = now[joints_[i]];
    const JointSample desired = path.at(now.time(), i);
    feedback.desired.positions.push_back(desired.position);
    feedback.desired.velocities.push_back(desired.velocity);
    feedback.desired.accelerations.push_back(desired.acceleration);
    feedback.actual.positions.push_back(state.position());
    feedback.actual.velocities.push_back(state.velocity());
    feedback.error.positions.push_back(desired.position - state.position());
    feedback.error.velocities.push_back(desired.velocity - state.velocity());
  }
  feedback.index = static_cast<int32_t>(path.path.point_at(now.time() - path.start_time));
  std::vector<uint8_t> bytes;
  if (interfaces_ == 1) {
    namespace fjt5 = control_msgs_5::action;
    fjt5::FollowJointTrajectory_FeedbackMessage old;
    old.goal_id.uuid = context.id();
    old.feedback.header = feedback.header;
    old.feedback.joint_names = feedback.joint_names;
    old.feedback.desired = feedback.desired;
    old.feedback.actual = feedback.actual;
    old.feedback.error = feedback.error;
    encode(old, &bytes);
  } else {
    encode(fjt::FollowJointTrajectory_FeedbackMessage{{context.id()}, std::move(feedback)}, &bytes);
  }
  context.feedback(bytes);
}

}  // namespace gloam::bridge
