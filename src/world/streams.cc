#include "world/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/text.h"
#include "gloam/outputs.h"
#include "gloam/world.h"
#include "scene/options/probe_quantities.h"
#include "world/agents/agent_bodies.h"
#include "world/compile/level.h"
#include "world/model_names.h"
#include "world/sensors/authored_lidar.h"
#include "world/sensors/camera_rate.h"
#include "world/sensors/sensor_description.h"
#include "world/sensors/visual_camera.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

constexpr const char* kWorldFrame = "world";

Pose pose_of(const mjtNum* p, const mjtNum* q) {
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

/// The body or site that a sensor sits on, where it sits on one.
struct Seat {
  int body = 0;
  Pose X_BS = {};
};

Seat seat_of(const mjModel& m, int sensor) {
  const int id = m.sensor_objid[sensor];
  switch (m.sensor_objtype[sensor]) {
    case mjOBJ_SITE:
      return {m.site_bodyid[id], pose_of(m.site_pos + 3 * id, m.site_quat + 4 * id)};
    case mjOBJ_BODY:
    case mjOBJ_XBODY:
      return {id};
    case mjOBJ_GEOM:
      return {m.geom_bodyid[id], pose_of(m.geom_pos + 3 * id, m.geom_quat + 4 * id)};
    case mjOBJ_JOINT:
      return {m.jnt_bodyid[id]};
    default:
      return {};
  }
}

const char* unit_of(const mjModel& m, int sensor) {
  switch (m.sensor_type[sensor]) {
    case mjSENS_TOUCH:
    case mjSENS_FORCE:
    case mjSENS_ACTUATORFRC:
    case mjSENS_TENDONACTFRC:
      return "N";
    case mjSENS_TORQUE:
      return "N m";
    case mjSENS_ACCELEROMETER:
    case mjSENS_FRAMELINACC:
      return "m/s²";
    case mjSENS_VELOCIMETER:
    case mjSENS_FRAMELINVEL:
      return "m/s";
    case mjSENS_GYRO:
    case mjSENS_FRAMEANGVEL:
    case mjSENS_BALLANGVEL:
      return "rad/s";
    case mjSENS_MAGNETOMETER:
      return "T";
    case mjSENS_RANGEFINDER:
    case mjSENS_FRAMEPOS:
      return "m";
    case mjSENS_JOINTPOS:
      return m.jnt_type[m.sensor_objid[sensor]] == mjJNT_SLIDE ? "m" : "rad";
    case mjSENS_JOINTVEL:
      return m.jnt_type[m.sensor_objid[sensor]] == mjJNT_SLIDE ? "m/s" : "rad/s";
    default:
      return "";
  }
}

class StreamLister {
 public:
  explicit StreamLister(const CompiledWorld& world) : world_(world), m_(*world.model) {}

  std::vector<StreamInfo> list() {
    add_cameras();
    add_lidars();
    add_sensors();
    for (const RobotInstance& robot : world_.robots) add_robot(robot);
    StreamInfo poses{.kind = StreamKind::kPoses, .name = kWorldFrame, .frame_id = kWorldFrame};
    for (int body = 1; body < static_cast<int>(m_.nbody); ++body)
      poses.outputs.push_back(body_label(body));
    poses.parent = handle(0);
    streams_.push_back(std::move(poses));
    return std::move(streams_);
  }

 private:
  Body handle(int body) const { return {body, world_.serial}; }
  std::string body_label(int body) const {
    const std::string name = name_of(m_, mjOBJ_BODY, body);
    return name.empty() ? fmt::format("body_{}", body) : name;
  }

  void add_cameras() {
    for (int i = 0; i < static_cast<int>(m_.ncam); ++i) {
      StreamInfo info{.kind = StreamKind::kCamera, .name = camera_name(m_, i)};
      info.frame_id = info.name + "_optical_frame";
      info.parent = handle(m_.cam_bodyid[i]);
      info.X_PS = pose_of(m_.cam_pos + 3 * i, m_.cam_quat + 4 * i);
      info.rate = own_camera_rate(world_.scene, info.name);
      info.outputs = outputs_of(info.name);
      streams_.push_back(std::move(info));
    }
  }

  std::vector<std::string> outputs_of(const std::string& camera) const {
    const auto found = std::ranges::find(world_.scene.cameras, camera, &CameraOptions::name);
    const CameraSensing sensing =
        found != world_.scene.cameras.end() ? found->sensing : CameraSensing();
    std::vector<std::string> outputs;
    for (const CameraChannel& channel : kCameraChannels)
      if (channel.has_model(sensing)) outputs.emplace_back(channel.name);
    return outputs;
  }

  void add_lidars() {
    const Result<std::vector<LidarDescription>> lidars = describe_lidars(world_);
    if (!lidars.ok()) return;  // a compiled World's are sound
    for (const LidarDescription& lidar : *lidars) {
      StreamInfo info{.kind = StreamKind::kLidar,
                      .name = lidar.options.name,
                      .frame_id = lidar.options.name,
                      .parent = handle(lidar.body),
                      .X_PS = lidar.X_BL};
      info.rate = lidar.options.rate.value_or(Rational{0, 1});
      info.outputs = {"points", "intensity", "range", "ring", "time"};
      if (lidar.options.truth) info.outputs.emplace_back("segmentation");
      info.unit = "m";
      streams_.push_back(std::move(info));
    }
  }

  void add_sensors() {
    const std::vector<SensorDescription> sensors = describe_sensors(world_);
    for (size_t i = 0; i < sensors.size(); ++i) {
      const int id = static_cast<int>(i);
      if (sensors[i].probe >= 0) {
        add_probe(world_.probes[static_cast<size_t>(sensors[i].probe)]);
        continue;
      }
      const Seat seat = seat_of(m_, id);
      StreamInfo info{.kind = StreamKind::kSensor, .name = sensors[i].name};
      const bool is_site = m_.sensor_objtype[id] == mjOBJ_SITE;
      const std::string site = is_site ? name_of(m_, mjOBJ_SITE, m_.sensor_objid[id]) : "";
      info.frame_id = !site.empty() ? site : seat.body == 0 ? kWorldFrame : body_label(seat.body);
      info.parent = handle(seat.body);
      info.X_PS = seat.X_BS;
      info.rate = sensors[i].rate;
      info.unit = unit_of(m_, id);
      for (int n = 0; n < sensors[i].count; ++n) info.outputs.push_back(fmt::format("{}", n));
      streams_.push_back(std::move(info));
    }
  }

  // Numbers of probes have world axes, wherever they are measured.
  void add_probe(const ProbeDescription& probe) {
    StreamInfo info{.kind = StreamKind::kSensor, .name = probe.options.name};
    info.frame_id = kWorldFrame;
    info.parent = handle(probe.body);
    info.X_PS = {probe.p_B, {}};
    info.rate = probe.options.rate;
    for (const ProbeNumber& number : probe.quantity->numbers) {
      if (number.name.empty()) continue;
      info.outputs.emplace_back(number.name);
      if (info.unit.empty()) info.unit = number.unit;
    }
    streams_.push_back(std::move(info));
  }

  void add_robot(const RobotInstance& robot) {
    StreamInfo joints{.kind = StreamKind::kJoints, .name = robot.name};
    joints.frame_id = robot.root_body > 0 ? body_label(robot.root_body) : kWorldFrame;
    joints.parent = handle(std::max(robot.root_body, 0));
    for (const int joint : robot_joints(m_, robot))
      if (m_.jnt_type[joint] != mjJNT_FREE)
        joints.outputs.push_back(name_of(m_, mjOBJ_JOINT, joint));
    streams_.push_back(std::move(joints));
  }

  const CompiledWorld& world_;
  const mjModel& m_;
  std::vector<StreamInfo> streams_;
};

InputInfo controls_of(const mjModel& m, const RobotInstance& robot) {
  InputInfo input{.kind = InputKind::kControls, .name = robot.name};
  for (const int actuator : robot_actuators(m, robot)) {
    const int control = m.actuator_ctrladr[actuator];
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const bool is_limited = m.actuator_ctrllimited[control] != 0;
    input.elements.push_back(name_of(m, mjOBJ_ACTUATOR, actuator));
    input.low.push_back(is_limited ? m.actuator_ctrlrange[2 * control] : -kInfinity);
    input.high.push_back(is_limited ? m.actuator_ctrlrange[2 * control + 1] : kInfinity);
  }
  return input;
}

}  // namespace

const char* to_string(StreamKind kind) {
  static constexpr const char* kNames[] = {"camera", "lidar", "sensor",
                                           "joints", "poses", "metrics"};
  return kNames[static_cast<size_t>(kind)];
}

const char* to_string(InputKind kind) {
  static constexpr const char* kNames[] = {"velocity", "controls", "mocap", "live_field"};
  return kNames[static_cast<size_t>(kind)];
}

const Scene& World::scene() const { return compiled_->scene; }

Scene written_scene(const World& world) { return world.compiled()->written; }

Result<Robot> World::find_robot(const std::string& name) const {
  std::vector<std::string> names;
  for (const RobotInstance& robot : compiled_->robots) {
    if (robot.name == name) return Robot{static_cast<int>(names.size()), compiled_->serial};
    names.push_back(robot.name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("there is no robot '{}'", name),
               {},
               suggest_name(name, names)};
}

std::vector<RobotInfo> World::robots() const {
  const mjModel& m = *compiled_->model;
  std::vector<RobotInfo> robots;
  for (const RobotInstance& robot : compiled_->robots) {
    RobotInfo& info = robots.emplace_back();
    info.robot = {static_cast<int>(robots.size()) - 1, compiled_->serial};
    info.name = robot.name;
    info.root = {robot.root_body, compiled_->serial};
    for (const int joint : robot_joints(m, robot))
      info.joints.push_back({joint, compiled_->serial});
    for (const int actuator : robot_actuators(m, robot))
      info.actuators.push_back({actuator, compiled_->serial});
  }
  return robots;
}

std::vector<BodyInfo> World::bodies() const {
  const mjModel& m = *compiled_->model;
  std::vector<BodyInfo> bodies;
  for (int body = 0; body < static_cast<int>(m.nbody); ++body) {
    BodyInfo& info = bodies.emplace_back();
    info.body = {body, compiled_->serial};
    info.parent = {m.body_parentid[body], compiled_->serial};
    info.name = name_of(m, mjOBJ_BODY, body);
    for (size_t robot = 0; robot < compiled_->robots.size(); ++robot) {
      const int root = compiled_->robots[robot].root_body;
      if (root > 0 && is_part_of(m, body, root))
        info.robot = {static_cast<int>(robot), compiled_->serial};
    }
  }
  return bodies;
}

std::vector<StreamInfo> list_streams(const CompiledWorld& world) {
  return StreamLister(world).list();
}

std::vector<InputInfo> list_inputs(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  std::vector<InputInfo> inputs;
  for (const RobotInstance& robot : world.robots) {
    if (robot.options.controller.type != "none")
      inputs.push_back({.kind = InputKind::kVelocity,
                        .name = robot.name,
                        .elements = {"vx", "vy", "yaw_rate"},
                        .unit = "m/s, m/s, rad/s"});
    InputInfo controls = controls_of(m, robot);
    if (!controls.elements.empty()) inputs.push_back(std::move(controls));
  }
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (m.body_mocapid[body] < 0) continue;
    const std::string name = name_of(m, mjOBJ_BODY, body);
    if (find_agent(world, body) == nullptr)
      inputs.push_back({.kind = InputKind::kMocap,
                        .name = name.empty() ? fmt::format("body_{}", body) : name,
                        .elements = {"x", "y", "z", "qw", "qx", "qy", "qz"},
                        .unit = "m, 1"});
  }
  for (InputInfo& input : inputs) input.count = static_cast<int64_t>(input.elements.size());
  return inputs;
}

}  // namespace gloam
