#pragma once
// The catalogue of robots for [[robot]] model (docs/robots.md), and settings for models from
// elsewhere. Part of gloam/scene.h.

#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/robot.h"

namespace gloam {

/// A sensor that a robot model can add to a scene.
struct RobotModelSensor {
  std::string name;  ///< for RobotOptions::sensors
  std::string kind;  ///< section of the scene: camera, lidar, stereo, rgbd, probe or sensor
};

/// A robot of the catalogue, or of another robot.toml.
struct RobotModelInfo {
  std::string name, description;
  std::filesystem::path file;  ///< its robot.toml
  RobotOptions defaults;       ///< settings that hold unless a scene gives others
  std::vector<RobotModelSensor> sensors;
  int joints = 0;            ///< hinges, slides and balls
  int actuators = 0;         ///< of the model
  bool is_floating = false;  ///< on a free joint
  double mass = 0;           ///< [kg]
};

/// All robots of the catalogue by their names: the folders of gloam_home()/assets/robots with a
/// robot.toml. Compiles each with all its sensors, from the cache after the first time. Errors:
/// as for robot_model(), of the first that fails.
Result<std::vector<RobotModelInfo>> robot_models();

/// One robot: a name of the catalogue, or the path of a robot.toml or of its folder. Errors:
/// no such robot; it does not compile.
Result<RobotModelInfo> robot_model(const std::string& model, const FileAccess& access = {});

/// Settings for a model from elsewhere.
struct RobotGuess {
  /// quadruped | humanoid | quadrotor | diff_drive | arm | other
  std::string kind;
  /// A [[robot]] for a scene in the current folder, with comments that give the reasons.
  std::string toml;
};

/// Proposes settings for an MJCF or URDF from the shape of its kinematic tree at its keyframe.
/// Errors: the file is not a model, or the model does not compile.
Result<RobotGuess> guess_robot(const std::filesystem::path& file, const FileAccess& access = {});

}  // namespace gloam
