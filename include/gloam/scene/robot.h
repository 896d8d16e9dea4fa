#pragma once
// Robots of a scene: files and controllers ([[robot]]), overrides of their models ([override]) and
// pushes ([[push]]). Part of gloam/scene.h.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/actuator.h"
#include "gloam/scene/controllers.h"
#include "gloam/types.h"

namespace gloam {

/// Limits on the files that a model may read. Models may be untrusted: see docs/security.md.
struct FileAccess {
  /// Files outside of it are not read; empty = determined by the rules in docs/security.md.
  std::filesystem::path root = {};
  bool strict = false;  ///< root = the model file's own folder
  /// package://NAME -> folder (URDF).
  std::vector<std::pair<std::string, std::filesystem::path>> packages = {};
};

/// One change of a velocity goal on the schedule of a robot's controller.
struct VelocityGoal {
  double time = 0;      ///< time from which it applies [s], >= 0
  double vx = 0;        ///< forward [m/s], in the robot's heading frame
  double vy = 0;        ///< left [m/s]
  double yaw_rate = 0;  ///< counter-clockwise seen from above [rad/s]
  double vz = 0;        ///< up [m/s], of a flying robot
  SourceLoc loc = {};
};

/// A value as written in a scene file: "0.5", "[1, 0, 0]", "08:30:00", "\"oak\"".
struct TomlText {
  std::string text = {};
};

/// Control of the pose of one frame of a robot.
struct TaskSpaceOptions {
  /// "site NAME", "body NAME" or "geom NAME", as in the robot's file.
  std::string frame = {};
  double position_cost = 1;         ///< ik: weight of the position's error [1/m]; 0 = free
  double orientation_cost = 1;      ///< ik: weight of the orientation's error [1/rad]; 0 = free
  double posture_cost = 0.01;       ///< ik: weight of the distance from the initial posture [1/rad]
  double time_constant = 0.1;       ///< ik: of the decay of the error within the limits [s]
  double velocity_limit = 2;        ///< ik: of each joint [rad/s or m/s]
  double collision_distance = 0;    ///< ik: kept from other geoms [m]; 0 = collisions are ignored
  double position_stiffness = 100;  ///< osc: per unit of effective mass [1/s²]; 0 = free
  double orientation_stiffness = 100;  ///< osc: per unit of effective inertia [1/s²]; 0 = free
  double posture_stiffness = 10;       ///< osc: of the initial posture in the null space [1/s²]
  double damping_ratio = 1;            ///< osc: of all three
};

/// [robot.controller]: the controller of a robot's actuators.
struct ControllerOptions {
  /// none | torque | joint_position | joint_velocity | joint_effort | trot | quadrotor | diff_drive
  /// | gripper | ik | osc | policy, or a type registered by the program (gloam/controller.h)
  std::string type = "none";
  /// Rate of the controller [Hz]; the model's step rate must be a multiple of it.
  Rational rate = {500, 1};
  double kp = 40;  ///< joint_*: stiffness, of joint_velocity the integral gain [N m/rad]
  double kd = 1;   ///< joint_*: damping [N m s/rad]
  /// joint_position: joint angles [rad], torque: torques [N m]; empty = keyframe / zero.
  std::vector<double> target = {};
  /// trot, quadrotor, diff_drive, policy: velocity goals over time; empty = stand or hover
  std::vector<VelocityGoal> goals = {};
  FlightOptions flight = {};            ///< quadrotor
  DriveOptions drive = {};              ///< diff_drive
  GripOptions grip = {};                ///< gripper
  std::filesystem::path network = {};   ///< policy: ONNX file, relative to the scene file
  std::filesystem::path settings = {};  ///< policy: TOML file; not needed if the metadata suffices
  /// Table of settings for a registered type. policy: values of the gait, such as frequency
  TomlText params = {};
  SourceLoc loc = {};
  TaskSpaceOptions task = {};  ///< ik, osc: keys of the same table
};

/// [[robot.part]]: joints of a robot that have a controller of their own, such as the arm on a
/// base.
struct RobotPart {
  std::string name = {};  ///< unique in its robot
  /// Names of its joints in the robot's own model, or regular expressions (RE2) that match whole
  /// names.
  std::vector<std::string> joints = {};
  ControllerOptions controller = {};  ///< without goals, which are the robot's
  SourceLoc loc = {};
};

/// [robot.joints]: the parts of a robot by their names in its own model, for controllers that would
/// otherwise find them by the robot's shape. Empty lists are found.
struct RobotJoints {
  /// Three hinges of each leg, from the hip to the foot.
  std::vector<std::string> front_left = {}, front_right = {}, rear_left = {}, rear_right = {};
  /// A geom, site or body of each foot, in the order of the legs above.
  std::vector<std::string> feet = {};
  SourceLoc loc = {};
};

/// [[robot]]: one MJCF or URDF file, attached under a name prefix "NAME/".
struct RobotOptions {
  std::string name = {};  ///< unique; prefix of all its elements; default: the name of its `model`
  /// Instead of `file`: a robot of the catalogue (docs/robots.md), or the path of a robot.toml or
  /// of its folder. Its settings hold unless they are given here. Loading or compiling a scene
  /// replaces it by these settings.
  std::string model = {};
  /// With `model`: names of the model's sensors that are added to the scene as ROBOT/SENSOR.
  std::vector<std::string> sensors = {};
  /// MJCF (.xml, .mjz, but not .mjb) or URDF (.urdf), relative to the scene file.
  std::filesystem::path file = {};
  Pose X_WR = {};             ///< pose of its root frame in the world
  std::string keyframe = {};  ///< initial pose by name; empty = the model's default
  /// model = as in its file (a URDF's root link is fixed); free = on a free joint "floating_base"
  std::string base = "model";
  ControllerOptions controller = {};  ///< of all joints that no part drives
  std::vector<RobotPart> parts = {};
  RobotJoints joints = {};
  std::optional<SharedActuatorOptions> actuators = {};  ///< the supply of its actuators
  std::vector<ActuatorOptions> actuator = {};  ///< empty = controls go to MuJoCo as they are
  SourceLoc loc = {};
};

/// [override.ROBOT.TAG."PATTERN"]: one attribute of elements of a robot's model, as in its file. An
/// exact name takes precedence over a pattern, and a later line over an earlier one.
struct OverrideOptions {
  std::string robot = {};  ///< name of a [[robot]], or "environment"
  /// MJCF element, such as "joint" or "position"; a section for all its elements, such as
  /// "actuator"; or an element that a model has once, such as "option" or "visual/map".
  std::string tag = {};
  /// Name in the robot's own model, or a regular expression (RE2) that matches whole names; empty
  /// for elements that a model has once.
  std::string pattern = {};
  std::string attribute = {};
  std::string value = {};  ///< as in MJCF: "0.5", "1 0 0", "true"
  SourceLoc loc = {};
};

/// [[push]]: a change of velocity for robustness tests, by an impulse at the body's centre of mass.
struct PushOptions {
  std::string body = {};  ///< full name
  double time = 0;        ///< [s]
  Vec3 velocity = {};     ///< change of the whole subtree's centre-of-mass velocity [m/s]
  SourceLoc loc = {};
};

}  // namespace gloam
