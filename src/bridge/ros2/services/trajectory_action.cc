// The action FollowJointTrajectory of one robot.

#include <algorithm>

#include "bridge/ros2/services/actions.h"
#include "bridge/ros2/services/trajectory_run.h"
#include "bridge/ros2/services/typed_service.h"
#include "ros/codec.h"
#include "ros/trajectory_check.h"

namespace gloam::bridge {
namespace {

namespace fjt = control_msgs::action;

constexpr std::string_view kInputName = "joint_trajectory";

bool is_trajectory_input(const TopicInfo& topic) {
  return topic.is_input && topic.type == "trajectory_msgs/msg/JointTrajectory" &&
         topic.name.ends_with(kInputName) && topic.source.kind == TopicSource::Kind::kRobot;
}

// Controllers that bring joints to goals: Gloam's own, and those of programs, which may.
bool obeys_joint_goals(const World& world, const std::string& robot) {
  const std::vector<RobotOptions>& robots = world.scene().robots;
  const auto found = std::ranges::find(robots, robot, &RobotOptions::name);
  if (found == robots.end()) return false;
  const std::string& type = found->controller.type;
  return type != "none" && type != "torque" && type != "trot";
}

}  // namespace

std::vector<std::string> trajectory_robots(Simulation& simulation) {
  std::vector<std::string> robots;
  const Result<std::vector<TopicInfo>> topics = simulation.topics();
  if (!topics.ok()) return robots;
  const World world = simulation.world();
  for (const TopicInfo& topic : *topics) {
    if (!is_trajectory_input(topic)) continue;
    if (obeys_joint_goals(world, topic.source.name)) robots.push_back(topic.source.name);
  }
  return robots;
}

Ros2Action trajectory_action(Simulation& simulation, const std::string& robot, int interfaces,
                             Ros2Publish publish) {
  ActionOptions options;
  options.name = "/" + robot + "/follow_joint_trajectory";
  if (const auto topics = simulation.topics(); topics.ok())
    for (const TopicInfo& topic : *topics)
      if (is_trajectory_input(topic) && topic.source.name == robot)
        options.name =
            topic.name.substr(0, topic.name.size() - kInputName.size()) + "follow_joint_trajectory";
  options.type = "control_msgs/action/FollowJointTrajectory";
  options.policy = GoalPolicy::kReplace;
  options.send_goal_hash = service_hash_of<fjt::FollowJointTrajectory_SendGoal_Request,
                                           fjt::FollowJointTrajectory_SendGoal_Response>();
  options.get_result_hash = service_hash_of<fjt::FollowJointTrajectory_GetResult_Request,
                                            fjt::FollowJointTrajectory_GetResult_Response>();
  options.clock = [&simulation] { return simulation.latest().time(); };
  options.unknown = trajectory_end(action_msgs::GoalStatus::STATUS_UNKNOWN, 0, "").response;
  options.accept = [&simulation, robot,
                    interfaces](std::span<const uint8_t> bytes) -> Result<GoalRequest> {
    GLOAM_TRY(auto request, decode<fjt::FollowJointTrajectory_SendGoal_Request>(bytes));
    GoalRequest goal{.id = request.goal_id.uuid};
    Result<JointTrajectory> trajectory = joint_trajectory_of(request.goal.trajectory);
    // Joints that are missing are answered below.
    const bool has_joints = !request.goal.trajectory.joint_names.empty();
    if ((!trajectory.ok() && has_joints) || !request.goal.multi_dof_trajectory.points.empty())
      return goal;  // refused, as joint_trajectory_controller does
    // Accepted and aborted, so that its client learns which joint is wrong.
    if (const auto joints =
            find_joints(simulation.latest(), robot, request.goal.trajectory.joint_names);
        !joints.ok()) {
      goal.end = trajectory_end(action_msgs::GoalStatus::STATUS_ABORTED,
                                fjt::FollowJointTrajectory_Result::INVALID_JOINTS,
                                joints.error().to_string());
      return goal;
    }
    const auto run = std::make_shared<TrajectoryRun>(simulation, robot, interfaces, request.goal,
                                                     std::move(*trajectory), goal.id);
    goal.run = [run](GoalContext& context) { return run->run(context); };
    return goal;
  };
  return make_action(std::move(options), std::move(publish));
}

}  // namespace gloam::bridge
