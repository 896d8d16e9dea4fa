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

constexpr double kGoalPeriod = 0.02;     // between goals of joints [s]
constexpr double kGoalLookahead = 0.1;   // goals that are under way [s]
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
                             const fjt::FollowJointTrajectory_Goal& goal, JointWay way)
    : simulation_(simulation),
      robot_(std::move(robot)),
      interfaces_(interfaces),
      names_(goal.trajectory.joint_names),
      way_(std::move(way)),
      path_(tolerances_of(goal.path_tolerance, names_)),
      goal_(tolerances_of(goal.goal_tolerance, names_)),
      stamp_(goal.trajectory.header.stamp.sec + 1e-9 * goal.trajectory.header.stamp.nanosec) {
  const auto& settling = goal.goal_time_tolerance;
  settling_ = settling.sec + 1e-9 * settling.nanosec;
  if (settling_ <= 0) settling_ = kLongestSettling;
}

GoalEnd TrajectoryRun::run(GoalContext& context) {
  Snapshot now = simulation_.latest();
  if (stamp_ > 0 && stamp_ + way_.end() < now.time())
    return aborted(JointResult::OLD_HEADER_TIMESTAMP,
                   "the trajectory ended before it was received");
  if (const Status begun = begin(now); !begun.ok())
    return aborted(JointResult::INVALID_GOAL, begun.error().to_string());
  SnapshotInbox inbox;
  const auto stream =
      simulation_.open_snapshots({.rate = rate_, .required = true, .capacity = 1},
                                 [&inbox](const Snapshot& snapshot) { inbox.put(snapshot); });
  if (!stream.ok()) return aborted(JointResult::INVALID_GOAL, stream.error().to_string());
  const InboxCloser closer{inbox};
  bool has_started = false;  // at the first Snapshot of the stream: from then on none is missed
  for (double before = now.time();;) {
    if (context.is_cancelled()) return cancelled(now);
    if (const Status posted = has_started ? post_ahead(now) : Status(); !posted.ok())
      return aborted(JointResult::INVALID_GOAL, posted.error().to_string());
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
    if (!std::exchange(has_started, true)) start(now);
    if (const std::optional<GoalEnd> end = look(now, context)) return *end;
  }
}

Status TrajectoryRun::begin(const Snapshot& now) {
  GLOAM_TRY_STATUS(find(now));
  GLOAM_TRY(const Robot robot, now.world().find_robot(robot_));
  GLOAM_TRY(lease_, simulation_.claim(robot));
  timestep_ = 1 / simulation_.step_rate().value();
  const Rational rate = simulation_.step_rate();
  if (rate.value() > kFeedbackRate) rate_ = {static_cast<int64_t>(kFeedbackRate), 1};
  return {};
}

void TrajectoryRun::start(const Snapshot& now) {
  start_ = std::max(now.time(), stamp_);
  for (const Joint joint : joints_) from_.push_back(now[joint].position());
}

Status TrajectoryRun::find(const Snapshot& now) {
  GLOAM_TRY(joints_, find_joints(now, robot_, names_));
  return {};
}

Status TrajectoryRun::post_ahead(const Snapshot& now) {
  const double until = std::min(now.time() - start_ + kGoalLookahead, way_.end());
  std::vector<Command> commands;
  while (posted_ < way_.end() && posted_ <= until) {
    posted_ = std::min(posted_ + kGoalPeriod, way_.end());
    const JointWayPoint point = way_.at(posted_, from_);
    const double ahead = start_ + posted_ - now.time();
    const int64_t step = now.step() + std::max<int64_t>(0, std::llround(ahead / timestep_));
    for (size_t i = 0; i < joints_.size(); ++i)
      commands.push_back({step, SetJointGoal{joints_[i], point.positions[i]}});
  }
  return commands.empty() ? Status() : lease_->post(commands);
}

GoalEnd TrajectoryRun::cancelled(const Snapshot& now) {
  std::vector<Command> commands;
  const int64_t ahead = std::llround((kGoalLookahead + kGoalPeriod) / timestep_);
  for (const Joint joint : joints_)
    for (const int64_t step : {now.step(), now.step() + ahead})
      commands.push_back({step, SetJointGoal{joint, now[joint].position()}});
  (void)lease_->post(commands);
  return trajectory_end(GoalState::STATUS_CANCELED, JointResult::SUCCESSFUL, "cancelled");
}

std::optional<GoalEnd> TrajectoryRun::look(const Snapshot& now, GoalContext& context) {
  const double time = now.time() - start_;
  if (time < 0) return {};
  const JointWayPoint desired = way_.at(time, from_);
  tell(now, desired, context);
  const bool is_over = time >= way_.end();
  const std::vector<Tolerance>& allowed = is_over ? goal_ : path_;
  const std::string beyond = joint_beyond(now, desired, allowed);
  if (is_over && beyond.empty())
    return trajectory_end(GoalState::STATUS_SUCCEEDED, JointResult::SUCCESSFUL, "");
  if (is_over && time > way_.end() + settling_)
    return aborted(JointResult::GOAL_TOLERANCE_VIOLATED,
                   "joint '" + beyond + "' did not reach its goal");
  if (!is_over && !beyond.empty())
    return aborted(JointResult::PATH_TOLERANCE_VIOLATED,
                   "joint '" + beyond + "' deviates from its path");
  return {};
}

std::string TrajectoryRun::joint_beyond(const Snapshot& now, const JointWayPoint& desired,
                                        const std::vector<Tolerance>& allowed) const {
  for (size_t i = 0; i < joints_.size(); ++i) {
    const JointState state = now[joints_[i]];
    const double off = std::abs(state.position() - desired.positions[i]);
    const double fast = std::abs(state.velocity() - desired.velocities[i]);
    if ((allowed[i].position > 0 && off > allowed[i].position) ||
        (allowed[i].velocity > 0 && fast > allowed[i].velocity))
      return names_[i];
  }
  return {};
}

void TrajectoryRun::tell(const Snapshot& now, const JointWayPoint& desired, GoalContext& context) {
  fjt::FollowJointTrajectory_Feedback feedback;
  feedback.header.stamp = ros_time_of(now.time());
  feedback.joint_names = names_;
  feedback.desired.positions = desired.positions;
  feedback.desired.velocities = desired.velocities;
  const auto time = ros_time_of(now.time() - start_);
  feedback.desired.time_from_start = {time.sec, time.nanosec};
  feedback.actual.time_from_start = feedback.error.time_from_start =
      feedback.desired.time_from_start;
  for (size_t i = 0; i < joints_.size(); ++i) {
    const JointState state = now[joints_[i]];
    feedback.actual.positions.push_back(state.position());
    feedback.actual.velocities.push_back(state.velocity());
    feedback.error.positions.push_back(desired.positions[i] - state.position());
    feedback.error.velocities.push_back(desired.velocities[i] - state.velocity());
  }
  feedback.index = static_cast<int32_t>(way_.segment(now.time() - start_));
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
