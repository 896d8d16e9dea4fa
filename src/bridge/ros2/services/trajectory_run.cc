#include "bridge/ros2/services/trajectory_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/threads/bounded_queue.h"
#include "ros/codec.h"
#include "ros/trajectory_check.h"

namespace gloam::bridge {
namespace {

namespace fjt = control_msgs::action;
using JointResult = fjt::FollowJointTrajectory_Result;
using GoalState = action_msgs::GoalStatus;

constexpr double kLongestSettling = 10;                // where the goal names no time for it [s]
constexpr std::chrono::milliseconds kLongestWait{50};  // for a Snapshot
constexpr int64_t kFeedbackRate = 50;                  // looks at the joints, and feedback [Hz]

/// Before a stream closes, its last callback must return.
struct SnapshotQueueCloser {
  BoundedQueue<Snapshot>& queue;
  ~SnapshotQueueCloser() { queue.close(); }
};

int64_t tag_of(const GoalId& id) {
  int64_t tag = 0;
  std::memcpy(&tag, id.data(), sizeof tag);
  return tag != 0 ? tag : -1;  // 0: trajectories of other origin
}

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
                             JointTrajectory trajectory, const GoalId& id)
    : simulation_(simulation),
      robot_(std::move(robot)),
      interfaces_(interfaces),
      names_(goal.trajectory.joint_names),
      trajectory_(std::move(trajectory)),
      message_{goal.trajectory},
      path_(tolerances_of(goal.path_tolerance, names_)),
      goal_(tolerances_of(goal.goal_tolerance, names_)),
      tag_(tag_of(id)) {
  const auto& settling = goal.goal_time_tolerance;
  settling_ = settling.sec + 1e-9 * settling.nanosec;
  if (settling_ <= 0) settling_ = kLongestSettling;
}

GoalEnd TrajectoryRun::run(GoalContext& context) {
  GoalEnd end = watch(context);
  // A newer goal continues from this one's motion; after any other end but success, joints hold.
  if (end.status != GoalState::STATUS_SUCCEEDED && !context.is_replaced() && is_posted_) stop();
  return end;
}

void TrajectoryRun::stop() {
  const Snapshot now = simulation_.latest();
  const Result<Robot> robot = now.world().find_robot(robot_);
  if (!robot.ok() || !find(now).ok()) return;
  std::vector<Joint> joints = joints_;
  if (now.step() > latest_start_)  // else it may still wait
    std::erase_if(joints, [&](Joint joint) { return !is_own(now.trajectory(joint)); });
  if (joints.empty()) return;
  static_cast<void>(simulation_.post({.what = StopTrajectory{*robot, std::move(joints)}}));
}

std::optional<GoalEnd> TrajectoryRun::asked_end(const GoalContext& context) {
  if (context.is_replaced())
    return aborted(JointResult::INVALID_GOAL, "a newer goal has replaced it");
  if (!context.is_cancelled()) return {};
  return trajectory_end(GoalState::STATUS_CANCELED, JointResult::SUCCESSFUL, "cancelled");
}

GoalEnd TrajectoryRun::watch(GoalContext& context) {
  if (const std::optional<GoalEnd> end = asked_end(context)) return *end;
  Snapshot now = simulation_.latest();
  Rational rate = simulation_.step_rate();
  if (rate.value() > kFeedbackRate) rate = {kFeedbackRate, 1};
  BoundedQueue<Snapshot> inbox({.items = 1}, Overflow::kWait);
  // A simulation that runs as fast as it can waits for each look, so that goals are not late.
  const auto stream = simulation_.open_snapshots({.rate = rate, .required = true, .capacity = 1},
                                                 [&inbox](const Snapshot& snapshot) {
                                                   inbox.push(snapshot);
                                                   inbox.wait_until_empty();
                                                 });
  if (!stream.ok()) return aborted(JointResult::INVALID_GOAL, stream.error().to_string());
  const SnapshotQueueCloser closer{inbox};
  if (const std::optional<GoalEnd> end = begin(now)) return *end;
  for (;;) {
    if (const std::optional<GoalEnd> end = asked_end(context)) return *end;
    const auto next_look = std::chrono::steady_clock::now() + kLongestWait;
    const Snapshot next = inbox.pop_until(next_look).value_or(Snapshot());
    if (!simulation_.status().ok())
      return aborted(JointResult::INVALID_GOAL, "the simulation has failed");
    if (!next) continue;
    if (next.time() < now.time()) {
      is_posted_ = false;
      return aborted(JointResult::INVALID_GOAL, "the simulation was reset");
    }
    if (next.world().compiled() != now.world().compiled()) {
      if (const Status found = find(next); !found.ok())
        return aborted(JointResult::INVALID_JOINTS, found.error().to_string());
    }
    now = next;
    if (const std::optional<GoalEnd> end = look(now, context)) return *end;
  }
}

std::optional<GoalEnd> TrajectoryRun::begin(const Snapshot& now) {
  const Result<int64_t> start =
      start_step(message_, now.time(), 1 / simulation_.step_rate().value());
  if (!start.ok()) {
    const bool is_old = message_.header.stamp.sec <= now.time();
    return aborted(is_old ? JointResult::OLD_HEADER_TIMESTAMP : JointResult::INVALID_GOAL,
                   start.error().to_string());
  }
  const auto post = [&]() -> Status {
    GLOAM_TRY_STATUS(find(now));
    GLOAM_TRY(const Robot robot, now.world().find_robot(robot_));
    return simulation_.post({*start, FollowTrajectory{robot, joints_, trajectory_, tag_}});
  };
  const Status posted = post();
  is_posted_ = posted.ok();
  if (!posted.ok()) return aborted(JointResult::INVALID_GOAL, posted.error().to_string());
  latest_start_ = std::max(*start, simulation_.latest().step());
  return {};
}

Status TrajectoryRun::find(const Snapshot& now) {
  GLOAM_TRY(joints_, find_joints(now, robot_, names_));
  return {};
}

std::optional<GoalEnd> TrajectoryRun::look(const Snapshot& now, GoalContext& context) {
  const bool is_followed =
      std::ranges::all_of(joints_, [&](Joint joint) { return is_own(now.trajectory(joint)); });
  if (!is_followed && now.step() > latest_start_)
    return aborted(JointResult::INVALID_GOAL, "another command has ended the trajectory");
  if (!is_followed) return {};
  const auto active = now.trajectory(joints_[0]);
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

}  // namespace gloam::bridge
