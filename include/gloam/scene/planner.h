#pragma once
// [planner]: motion planning of one robot (docs/navigation.md). Part of gloam/scene.h.

#include <filesystem>
#include <string>

#include "gloam/result.h"

namespace gloam {

/// [planner]: turns observations into velocities of a robot. `gloam navigate` runs it: planners are
/// Python code, networks, shared libraries or other processes. Its goal is the robot's [[goal]].
struct PlannerOptions {
  std::string type = {};    ///< straight replay route route_mppi lidar gloam gnm vint nomad library
                            ///< external, or a registered name
  std::string robot = {};   ///< empty = the only robot of the scene
  std::string camera = {};  ///< empty = the first camera of the robot
  std::string lidar = {};   ///< empty = the first LiDAR of the scene
  std::filesystem::path map = {};      ///< folder of a topological map
  std::filesystem::path weights = {};  ///< ONNX file; nomad: folder with three
  std::filesystem::path library = {};  ///< library: shared library (gloam/planner/plugin.h)
  std::string command = {};  ///< external: the program to start; empty = it is running already
  std::string address = {};  ///< external: of its ZeroMQ socket
  double rate = 0;           ///< calls per second of simulation time [Hz]; 0 = the planner's
  /// From an observation until its answer applies, in simulation time [s]; -1 = the planner's.
  double latency = -1;
  double top_speed = 0.4;  ///< [m/s]
  SourceLoc loc = {};
};

}  // namespace gloam
