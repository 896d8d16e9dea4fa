#pragma once
// Lists of what a simulation can say and hear.

#include <cstdint>
#include <string>
#include <vector>

#include "gloam/handle.h"
#include "gloam/types.h"

namespace gloam {

enum class StreamKind : uint8_t {
  kCamera,  ///< CameraFrame, Simulation::open_camera
  kLidar,   ///< LidarScan, Simulation::open_lidar
  kSensor,  ///< SensorMessage, Simulation::open_sensor
  kJoints,  ///< positions and velocities of a robot's joints, in each Snapshot
  kPoses,   ///< poses of all bodies, from each Snapshot
};
const char* to_string(StreamKind kind);  ///< "camera", "lidar" …

struct StreamInfo {
  StreamKind kind = StreamKind::kCamera;
  std::string name;        ///< as its request asks for it; of joints: the robot's; "world"
  std::string frame_id;    ///< of its data: cameras "NAME_optical_frame", else NAME or the body's
  Body parent;             ///< that it moves with
  Pose X_PS = {};          ///< of the sensor in that body; cameras look along -Z
  Rational rate = {0, 1};  ///< [Hz] of simulation time, the sensor's own; 0 = every step
  std::vector<std::string> outputs = {};  ///< channels, or names of joints and bodies
  std::string unit = {};                  ///< of a sensor's numbers, where it is known
};

/// A number that a run of a World tells of each instant (docs/metrics.md).
struct MetricInfo {
  std::string name;       ///< column of metrics.csv: "ada.path_length_m"
  std::string unit;       ///< "m", "m/s" …; "" = none
  std::string robot;      ///< robot that it is of; "" = the scene's, or the only one's
  bool declared = false;  ///< by a [[metric]], not built in
};

enum class InputKind : uint8_t {
  kVelocity,   ///< SetVelocityGoal of a robot
  kControls,   ///< SetControls of a robot, or SetControl of one actuator
  kMocap,      ///< SetMocapPose of a body
  kLiveField,  ///< SetLiveField of the model
};
const char* to_string(InputKind kind);

struct InputInfo {
  InputKind kind = InputKind::kControls;
  std::string name;                         ///< of the robot, body or field
  std::vector<std::string> elements = {};   ///< actuators in order, or axes; of live fields none
  int64_t count = 0;                        ///< numbers that it takes
  std::vector<double> low = {}, high = {};  ///< limits of each element, or one of all
  std::string unit = {};
};

}  // namespace gloam
