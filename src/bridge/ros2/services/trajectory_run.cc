#include "bridge/ros2/services/trajectory_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/snapshot_inbox.h"
#include "ros/codec.h"
#include "ros/messages/control_msgs_5.h"
#include "ros/trajectory_check.h"

namespace gloam::bridge {
namespace {

namespace fjt = control_msgs::action;
using JointResult = fjt::FollowJointTrajectory_Result;
using GoalState = action_msgs::GoalStatus;

constexpr double kLongestSettling = 10;  // where the goal names no time for it [s]
constexpr double kFeedbackRate = 50;     // looks at the joints, and feedback [Hz]

GoalEnd aborted(int32_t code, std::string text) {
  return trajectory_end(GoalState::STATUS_ABORTED, code, std::move(text));
}

}  // namespace

GoalEnd trajectory_end(int8_t status, int32_t code, std::string text) {
  fjt::FollowJointTrajectory_GetResult_Response response;
  response.status = status;
  response.result = {code, std::move(text)};
  GoalEnd end{.status = status};
  encode(response, &end.response);
  return end;
}

Result<std::vector<Joint>> find_joints(const Snapshot& snapshot, const std::string& robot,
                                       const std::vector<std::string>& names) {
  const World world = snapshot.world();
  GLOAM_TRY_STATUS(world.find_robot(robot));
  GLOAM_TRY_STATUS(check_joint_names(names));
  std::vector<Joint> joints;
  for (const std::string& name : names) {
    Result<Joint> joint = world.find_joint(robot + "/" + name);
    if (!joint.ok()) joint = world.find_joint(name);
    if (!joint.ok()) return joint.error();
    if (snapshot[*joint].qpos.size() != 1)
      return Error{ErrorKind::kInput, "joint '" + name + "' is neither a hinge nor a slide"};
    if (std::ranges::any_of(joints, [&](const Joint& other) { return other.id == joint->id; }))
      return Error{ErrorKind::kInput, "joint '" + name + "' is listed twice"};
    joints.push_back(*joint);
  }
  return joints;
}

std::vector<TrajectoryRun::Tolerance> TrajectoryRun::tolerances_of(
    const std::vector<control_msgs::JointTolerance>& list, const std::vector<std::string>& joints) {
  std::vector<Tolerance> all(joints.size());
  for (const control_msgs::JointTolerance& one : list) {
    const auto found = std::ranges::find(joints, one.name);
    if (found == joints.end()) continue;
    all[static_cast<size_t>(found - joints.begin())] = {std::max(0.0, one.position),
                                                        std::max(0.0, one.velocity)};
  }
  return all;
}

TrajectoryRun::TrajectoryRun(Simulation& simulation, std::string robot, int interfaces,
                             const fjt::FollowJointTrajectory_Goal& goal,
                             JointTrajectory trajectory)
    : simulation_(simulation),
      robot_(std::move(robot)),
      interfaces_(interfaces),
      names_(goal.trajectory.joint_names),
      trajectory_(std::move(trajectory)),
      message_{goal.trajectory.header, {}, {}},
      path_(tolerances_of(goal.path_tolerance, names_)),
      goal_(tolerances_of(goal.goal_tolerance, names_)),
      stamp_(goal.trajectory.header.stamp.sec + 1e-9 * goal.trajectory.header.stamp.nanosec) {
  const auto& settling = goal.goal_time_tolerance;
  settling_ = settling.sec + 1e-9 * settling.nanosec;
  if (settling_ <= 0) settling_ = kLongestSettling;
}

GoalEnd TrajectoryRun::run(GoalContext& context) {
  GoalEnd end = watch(context);
  // A newer goal continues from this one's motion; after any other end but success, joints hold.
  if (end.status != GoalState::STATUS_SUCCEEDED && !context.is_replaced() && lease_ != nullptr)
    if (const auto robot = simulation_.world().find_robot(robot_); robot.ok())
      static_cast<void>(lease_->post(Command{.what = StopTrajectory{*robot}}));
  return end;
}

GoalEnd TrajectoryRun::watch(GoalContext& context) {
  Snapshot now = simulation_.latest();
  if (stamp_ > 0 && stamp_ + trajectory_.points.back().time < now.time())
    return aborted(JointResult::OLD_HEADER_TIMESTAMP,
                   "the trajectory ended before it was received");
  const Rational steps = simulation_.step_rate();
  rate_ = steps.value() > kFeedbackRate ? Rational{static_cast<int64_t>(kFeedbackRate), 1} : steps;
  SnapshotInbox inbox;
  const auto stream =
      simulation_.open_snapshots({.rate = rate_, .required = true, .capacity = 1},
                                 [&inbox](const Snapshot& snapshot) { inbox.put(snapshot); });
  if (!stream.ok()) return aborted(JointResult::INVALID_GOAL, stream.error().to_string());
  const InboxCloser closer{inbox};
  if (const Status begun = begin(now); !begun.ok())
    return aborted(JointResult::INVALID_GOAL, begun.error().to_string());
  for (double before = now.time();;) {
    if (context.is_cancelled())
      return trajectory_end(GoalState::STATUS_CANCELED, JointResult::SUCCESSFUL, "cancelled");
    const Snapshot next = inbox.take();
    if (!simulation_.status().ok())
      return aborted(JointResult::INVALID_GOAL, "the simulation has failed");
    if (!next) continue;
    if (next.time() < before) return aborted(JointResult::INVALID_GOAL, "the simulation was reset");
    before = next.time();
    if (next.world().compiled() != now.world().compiled()) {
      if (const Status found = find(next); !found.ok())
        return aborted(JointResult::INVALID_JOINTS, found.error().to_string());
    }
    now = next;
    if (const std::optional<GoalEnd> end = look(now, context)) return *end;
  }
}

Status TrajectoryRun::begin(const Snapshot& now) {
  GLOAM_TRY_STATUS(find(now));
  GLOAM_TRY(const Robot robot, now.world().find_robot(robot_));
  GLOAM_TRY(lease_, simulation_.claim(robot));
  const double timestep = 1 / simulation_.step_rate().value();
  posted_step_ = now.step();
  return lease_->post(Command{start_step(message_, now.time(), timestep),
                              FollowTrajectory{robot, joints_, trajectory_}});
}

Status TrajectoryRun::find(const Snapshot& now) {
  GLOAM_TRY(joints_, find_joints(now, robot_, names_));
  return {};
}

std::optional<GoalEnd> TrajectoryRun::look(const Snapshot& now, GoalContext& context) {
  const Result<Robot> robot = now.world().find_robot(robot_);
  const auto active = robot.ok() ? now.trajectory(*robot) : nullptr;
  const bool is_known = active != nullptr && active->joints.size() == joints_.size();
  if (start_step_ < 0 && is_known && active->start_step >= posted_step_)
    start_step_ = active->start_step;
  if (start_step_ < 0) return {};
  if (!is_known || active->start_step != start_step_)
    return aborted(JointResult::INVALID_GOAL, "another command has ended the trajectory");
  tell(now, *active, context);
  return end_of(now, *active);
}

std::optional<GoalEnd> TrajectoryRun::end_of(const Snapshot& now,
                                             const ActiveTrajectory& path) const {
  const bool is_over = now.time() >= path.end_time();
  const std::string beyond = joint_beyond(now, path, is_over ? goal_ : path_);
  if (is_over && beyond.empty())
    return trajectory_end(GoalState::STATUS_SUCCEEDED, JointResult::SUCCESSFUL, "");
  if (is_over && now.time() > path.end_time() + settling_)
    return aborted(JointResult::GOAL_TOLERANCE_VIOLATED,
                   "joint '" + beyond + "' did not reach its goal");
  if (!is_over && !beyond.empty())
    return aborted(JointResult::PATH_TOLERANCE_VIOLATED,
                   "joint '" + beyond + "' deviates from its path");
  return {};
}

std::string TrajectoryRun::joint_beyond(const Snapshot& now, const ActiveTrajectory& path,
                                        const std::vector<Tolerance>& allowed) const {
  for (size_t i = 0; i < joints_.size(); ++i) {
    const JointState state = now[joints_[i]];
    const JointSample desired = path.at(now.time(), i);
    const double off = std::abs(state.position() - desired.position);
    const double fast = std::abs(state.velocity() - desired.velocity);
    if ((allowed[i].position > 0 && off > allowed[i].position) ||
        (allowed[i].velocity > 0 && fast > allowed[i].velocity))
      return names_[i];
  }
  return {};
}

void TrajectoryRun::tell(const Snapshot& now, const ActiveTrajectory& path, GoalContext& context) {
  fjt::FollowJointTrajectory_Feedback feedback;
  feedback.header.stamp = ros_time_of(now.time());
  feedback.joint_names = names_;
  const auto time = ros_time_of(now.time() - path.start_time);
  feedback.desired.time_from_start = {time.sec, time.nanosec};
  feedback.actual.time_from_start = feedback.error.time_from_start =
      feedback.desired.time_from_start;
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
    old.feedback = {feedback.header,
                    feedback.joint_names,
                    feedback.desired,
                    feedback.actual,
                    feedback.error,
                    {},
                    {},
                    {},
                    {}};
    encode(old, &bytes);
  } else {
    encode(fjt::FollowJointTrajectory_FeedbackMessage{{context.id()}, std::move(feedback)}, &bytes);
  }
  context.feedback(bytes);
}

}  // namespace gloam::bridge
