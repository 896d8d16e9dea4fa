#pragma once
// Robots of a scene: files and controllers ([[robot]]), overrides of their models ([override]) and
// pushes ([[push]]). Part of gloam/scene.h.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"
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
  SourceLoc loc = {};
};

/// A value as written in a scene file: "0.5", "[1, 0, 0]", "08:30:00", "\"oak\"".
struct TomlText {
  std::string text = {};
};

/// [robot.controller]: the controller of a robot's actuators.
struct ControllerOptions {
  /// none | torque | joint_position | trot, or a type registered by the program
  /// (gloam/controller.h)
  std::string type = "none";
  /// Rate of the controller [Hz]; the model's step rate must be a multiple of it.
  Rational rate = {500, 1};
  double kp = 40;  ///< joint_position: stiffness [N m/rad]
  double kd = 1;   ///< joint_position: damping [N m s/rad]
  /// joint_position: joint angles [rad], torque: torques [N m]; empty = keyframe / zero.
  std::vector<double> target = {};
  std::vector<VelocityGoal> goals = {};  ///< trot: velocity goals over time; empty = stand
  TomlText params = {};                  ///< table of settings for a registered type
  SourceLoc loc = {};
};

/// [[robot]]: one MJCF or URDF file, attached under a name prefix "NAME/".
struct RobotOptions {
  std::string name = {};  ///< unique; prefix of all its elements
  /// MJCF (.xml, .mjz, but not .mjb) or URDF (.urdf), relative to the scene file.
  std::filesystem::path file = {};
  Pose X_WR = {};             ///< pose of its root frame in the world
  std::string keyframe = {};  ///< initial pose by name; empty = the model's default
  /// model = as in its file (a URDF's root link is fixed); free = on a free joint "floating_base"
  std::string base = "model";
  ControllerOptions controller = {};
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
