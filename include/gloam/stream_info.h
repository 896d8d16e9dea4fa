#pragma once
// Outputs and inputs of a simulation.

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
  kJoints,  ///< positions and velocities of a robot's joints, from each Snapshot
  kPoses,   ///< poses of all bodies, from each Snapshot
};
const char* to_string(StreamKind kind);  ///< "camera", "lidar" …

struct StreamInfo {
  StreamKind kind = StreamKind::kCamera;
  std::string name;      ///< name for its request; for joints, name of the robot; "world"
  std::string frame_id;  ///< frame of its data: cameras "NAME_optical_frame", otherwise NAME or the
                         ///< name of the body
  Body parent;           ///< body on which the sensor is mounted
  Pose X_PS = {};        ///< pose of the sensor in that body; cameras look along -Z
  Rational rate = {0, 1};  ///< the sensor's own rate in simulation time [Hz]; 0 = every step
  std::vector<std::string> outputs = {};  ///< channels, or names of joints and bodies
  std::string unit = {};                  ///< unit of a sensor's numbers, if known
};

/// A number that a run of a World computes for each instant (docs/metrics.md).
struct MetricInfo {
  std::string name;       ///< column of metrics.csv: "ada.path_length_m"
  std::string unit;       ///< "m", "m/s" …; "" = none
  std::string robot;      ///< robot; "" = the scene, or the only robot
  bool declared = false;  ///< by a [[metric]]; false = built in
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
  std::string name;                         ///< name of the robot, body or field
  std::vector<std::string> elements = {};   ///< actuators in order, or axes; empty for live fields
  int64_t count = 0;                        ///< number of values that it takes
  std::vector<double> low = {}, high = {};  ///< limits for each element, or one for all
  std::string unit = {};
};

}  // namespace gloam
