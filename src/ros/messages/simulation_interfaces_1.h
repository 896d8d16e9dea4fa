#pragma once
// Shapes of simulation_interfaces 1.x, as Humble, Jazzy and Kilted have them, where they differ
// from those of 2.1: addresses and texts lie in the requests themselves, and SetEntityState sets
// all.

#include "ros/messages/simulation_services.h"

namespace gloam::simulation_interfaces_1 {

using simulation_interfaces::Bounds;
using simulation_interfaces::EntityState;
using simulation_interfaces::Result;
using simulation_interfaces::WorldResource;

inline constexpr std::string_view kPackage = "simulation_interfaces/msg";

struct Spawnable {
  std::string uri;
  std::string description;
  Bounds spawn_bounds;
  GLOAM_MESSAGE(Spawnable, uri, description, spawn_bounds)
};

namespace srv {

inline constexpr std::string_view kPackage = "simulation_interfaces/srv";

struct SpawnEntity_Request {
  std::string name;
  bool allow_renaming = false;
  std::string uri;
  std::string resource_string;
  std::string entity_namespace;
  geometry_msgs::PoseStamped initial_pose;
  GLOAM_MESSAGE(SpawnEntity_Request, name, allow_renaming, uri, resource_string, entity_namespace,
                initial_pose)
};

struct SetEntityState_Request {
  std::string entity;
  EntityState state;
  GLOAM_MESSAGE(SetEntityState_Request, entity, state)
};

struct GetSpawnables_Response {
  Result result;
  std::vector<Spawnable> spawnables;
  GLOAM_MESSAGE(GetSpawnables_Response, result, spawnables)
};

struct LoadWorld_Request {
  std::string uri;
  std::string resource_string;
  bool fail_on_unsupported_element = false;
  bool ignore_missing_or_unsupported_assets = false;
  GLOAM_MESSAGE(LoadWorld_Request, uri, resource_string, fail_on_unsupported_element,
                ignore_missing_or_unsupported_assets)
};

}  // namespace srv
}  // namespace gloam::simulation_interfaces_1
