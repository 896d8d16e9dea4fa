// Topics of robots: joints, odometry, the model.

#include "base/files.h"
#include "ros/messages/nav_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "scene/files/xml_scan.h"
#include "topics/model_frames.h"
#include "topics/robot_urdf.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/model_names.h"
#include "world/world.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

/// The hinges and slides of a robot: JointState has one number for each.
struct JointList {
  std::vector<int> ids;
  std::vector<std::string> names;
};

JointList joints_of(const mjModel& m, const RobotInstance& robot) {
  JointList joints;
  for (const int id : robot_joints(m, robot)) {
    if (m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE) continue;
    joints.ids.push_back(id);
    joints.names.push_back(joint_label(m, id, robot.prefix));
  }
  return joints;
}

// Effort is what the actuators apply to the joint at this state, mjData::qfrc_actuator.
InstantEncoder joint_states(JointList joints) {
  return [joints = std::move(joints)](const TopicInfo& topic, TopicInstant& at,
                                      MessageBytes* out) -> Status {
    const Snapshot& now = at.snapshot();
    GLOAM_TRY(const Instant* forces, at.forces());
    sensor_msgs::JointState message;
    message.header = ros_header(now.time(), topic.frame_id);
    message.name = joints.names;
    for (const int id : joints.ids) {
      const JointState state = now[Joint{id, 0}];
      message.position.push_back(state.position());
      message.velocity.push_back(state.velocity());
      message.effort.push_back(forces->data()->qfrc_actuator[at.model().jnt_dofadr[id]]);
    }
    encode(message, out);
    return {};
  };
}

// REP 105: pose in the fixed frame, twist in the body's own.
InstantEncoder odometry(int joint, int body) {
  return [joint, body](const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
    const JointState state = at.snapshot()[Joint{joint, 0}];
    const std::span<const double> q = state.qpos, v = state.qvel;
    nav_msgs::Odometry message;
    message.header = ros_header(at.snapshot().time(), topic.frame_id);
    message.child_frame_id = body_frame(at.model(), body);
    const Quat orientation = {q[3], q[4], q[5], q[6]};
    message.pose.pose = ros_pose({{q[0], q[1], q[2]}, orientation});
    message.twist.twist.linear = ros_vector(rotate_back(orientation, {v[0], v[1], v[2]}));
    message.twist.twist.angular = {v[3], v[4], v[5]};  // MuJoCo's is in the body's frame already
    encode(message, out);
    return Status();
  };
}

// A URDF as it is, since it is what ROS's tools read; of another file the URDF of its model.
LatchedEncoder description(const TopicWorld& world, size_t robot) {
  return [world, robot](const TopicInfo&, const LatchedInputs&, MessageBytes* out) -> Status {
    const RobotInstance& instance = world->robots[robot];
    std::string text;
    if (const auto file = read_file(instance.options.file); file.ok())
      text.assign(file->begin(), file->end());
    const auto scan = scan_model_xml(text, instance.options.file.string());
    if (!scan.ok() || scan->root != "robot") text = robot_urdf(*world->model, instance);
    encode(std_msgs::String{std::move(text)}, out);
    return {};
  };
}

}  // namespace

void add_robot_topics(const TopicWorld& world, TopicTable* table) {
  const mjModel& m = *world->model;
  for (const RobotInstance& robot : world->robots) {
    const std::string space = "/" + topic_token(robot.name);
    const TopicSource source = {TopicSource::Kind::kRobot, robot.name};
    const std::string root = robot.root_body > 0 ? body_frame(m, robot.root_body) : kWorldFrameId;
    if (JointList joints = joints_of(m, robot); !joints.ids.empty())
      table->push_back({{.name = space + "/joint_states",
                         .type = type_name<sensor_msgs::JointState>(),
                         .frame_id = root,
                         .rate = kStateRate,
                         .source = source},
                        {},
                        {},
                        joint_states(std::move(joints))});
    for (const int joint : robot_joints(m, robot)) {
      if (m.jnt_type[joint] != mjJNT_FREE || m.jnt_bodyid[joint] != robot.root_body) continue;
      table->push_back({{.name = space + "/odom",
                         .type = type_name<nav_msgs::Odometry>(),
                         .frame_id = kWorldFrameId,
                         .rate = kStateRate,
                         .source = source},
                        {},
                        {},
                        odometry(joint, robot.root_body)});
    }
    if (robot.root_body > 0)
      table->push_back({{.name = space + "/robot_description",
                         .type = type_name<std_msgs::String>(),
                         .qos = kLatchedQos,
                         .source = source,
                         .is_large = true},
                        {},
                        {},
                        description(world, static_cast<size_t>(&robot - world->robots.data()))});
  }
}

}  // namespace gloam
