#pragma once
// Autonomous people and vehicles: [[agent]], [[crowd]], [navigation]. Part of gloam/scene.h;
// docs/agents.md has examples.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [navigation]: navigable ground of agents, computed by Recast from the colliders.
struct NavigationOptions {
  double cell = 0.1;        ///< edge of its voxels in the plane [m]
  double headroom = 1.9;    ///< [m]
  double radius = 0.3;      ///< distance that people keep from walls [m]
  double climb = 0.22;      ///< maximum step height without stairs [m]
  double slope = 40;        ///< [deg]
  Rational rate = {10, 1};  ///< decisions per second of simulation time
  SourceLoc loc = {};
};

/// One waypoint of an agent.
struct WaypointOptions {
  Vec3 position = {};  ///< on the ground below [m]
  double pause = 0;    ///< time that the agent waits there [s]
  SourceLoc loc = {};
};

/// [[agent]]: a person or vehicle that moves by itself and is not a robot.
struct AgentOptions {
  std::string name = {};                    ///< unique
  std::string kind = "person";              ///< person | cart | forklift | car
  Vec3 position = {};                       ///< on the ground below, at the start [m]
  double heading = 0;                       ///< at the start, from +x to +y [deg]
  uint64_t seed = 0;                        ///< seed of body, clothes, paint and decisions
  std::optional<double> height = {};        ///< height of a person [m]; default: random
  std::optional<double> speed = {};         ///< preferred speed [m/s]; default: depends on its kind
  std::string behavior = "wander";          ///< stand | wander | route | spline | tree
  std::vector<WaypointOptions> route = {};  ///< stations in order, or a spline's points
  bool loop = true;                         ///< continue from the last waypoint to the first
  std::filesystem::path tree = {};          ///< behaviour tree, BehaviorTree.CPP's XML
  double start = 0;                         ///< time of its first step [s]
  bool yields = true;  ///< can be pushed aside, and stops for obstacles; false: keeps moving
  SourceLoc loc = {};
};

/// [[crowd]]: people at random places of the navigable ground.
struct CrowdOptions {
  std::string name = {};             ///< unique; they are NAME0, NAME1 …
  int count = 4;                     ///< number of people
  uint64_t seed = 0;                 ///< seed of all of them
  std::optional<double> speed = {};  ///< preferred speed [m/s]; default: random
  bool yields = true;                ///< as for [[agent]]
  SourceLoc loc = {};
};

}  // namespace gloam
