#pragma once
// Services and the action of ROS 2's package simulation_interfaces 2.1. A list longer than others:
// the package has 22 services.

#include "ros/messages/action_msgs.h"
#include "ros/messages/simulation_interfaces.h"

namespace gloam::simulation_interfaces {
namespace srv {

inline constexpr std::string_view kPackage = "simulation_interfaces/srv";

struct GetSimulatorFeatures_Request {
  GLOAM_MESSAGE(GetSimulatorFeatures_Request)
};
struct GetSimulatorFeatures_Response {
  SimulatorFeatures features;
  GLOAM_MESSAGE(GetSimulatorFeatures_Response, features)
};

struct GetSimulationState_Request {
  GLOAM_MESSAGE(GetSimulationState_Request)
};
struct GetSimulationState_Response {
  SimulationState state;
  Result result;
  GLOAM_MESSAGE(GetSimulationState_Response, state, result)
};

struct SetSimulationState_Request {
  SimulationState state;
  GLOAM_MESSAGE(SetSimulationState_Request, state)
};
struct SetSimulationState_Response {
  Result result;
  GLOAM_CONSTANTS(uint8, ALREADY_IN_TARGET_STATE = 101, STATE_TRANSITION_ERROR = 102,
                  INCORRECT_TRANSITION = 103)
  GLOAM_MESSAGE(SetSimulationState_Response, result)
};

struct StepSimulation_Request {
  uint64_t steps = 1;
  GLOAM_DEFAULTS(steps = 1)
  GLOAM_MESSAGE(StepSimulation_Request, steps)
};
struct StepSimulation_Response {
  Result result;
  GLOAM_MESSAGE(StepSimulation_Response, result)
};

struct ResetSimulation_Request {
  uint8_t scope = 0;
  GLOAM_CONSTANTS(uint8, SCOPE_DEFAULT = 0, SCOPE_TIME = 1, SCOPE_STATE = 2, SCOPE_SPAWNED = 4,
                  SCOPE_ALL = 255)
  GLOAM_MESSAGE(ResetSimulation_Request, scope)
};
struct ResetSimulation_Response {
  Result result;
  GLOAM_MESSAGE(ResetSimulation_Response, result)
};

struct SpawnEntity_Request {
  std::string name;
  bool allow_renaming = false;
  Resource entity_resource;
  std::string entity_namespace;
  geometry_msgs::PoseStamped initial_pose;
  GLOAM_MESSAGE(SpawnEntity_Request, name, allow_renaming, entity_resource, entity_namespace,
                initial_pose)
};
struct SpawnEntity_Response {
  Result result;
  std::string entity_name;
  GLOAM_CONSTANTS(uint8, NAME_NOT_UNIQUE = 101, NAME_INVALID = 102, UNSUPPORTED_FORMAT = 103,
                  NO_RESOURCE = 104, NAMESPACE_INVALID = 105, RESOURCE_PARSE_ERROR = 106,
                  MISSING_ASSETS = 107, UNSUPPORTED_ASSETS = 108, INVALID_POSE = 109)
  GLOAM_MESSAGE(SpawnEntity_Response, result, entity_name)
};

struct SpawnEntities_Request {
  std::vector<SpawnEntity> spawn_requests;
  GLOAM_MESSAGE(SpawnEntities_Request, spawn_requests)
};
struct SpawnEntities_Response {
  Result result;
  std::vector<SpawnResult> results;
  GLOAM_CONSTANTS(uint8, ENTITIES_SPAWN_FAILED = 150)
  GLOAM_MESSAGE(SpawnEntities_Response, result, results)
};

struct DeleteEntity_Request {
  std::string entity;
  GLOAM_MESSAGE(DeleteEntity_Request, entity)
};
struct DeleteEntity_Response {
  Result result;
  GLOAM_MESSAGE(DeleteEntity_Response, result)
};

struct GetEntities_Request {
  EntityFilters filters;
  GLOAM_MESSAGE(GetEntities_Request, filters)
};
struct GetEntities_Response {
  Result result;
  std::vector<std::string> entities;
  GLOAM_MESSAGE(GetEntities_Response, result, entities)
};

struct GetEntitiesStates_Request {
  EntityFilters filters;
  GLOAM_MESSAGE(GetEntitiesStates_Request, filters)
};
struct GetEntitiesStates_Response {
  Result result;
  std::vector<std::string> entities;
  std::vector<EntityState> states;
  GLOAM_MESSAGE(GetEntitiesStates_Response, result, entities, states)
};

struct GetEntityState_Request {
  std::string entity;
  GLOAM_MESSAGE(GetEntityState_Request, entity)
};
struct GetEntityState_Response {
  Result result;
  EntityState state;
  GLOAM_MESSAGE(GetEntityState_Response, result, state)
};

struct SetEntityState_Request {
  std::string entity;
  EntityState state;
  bool set_pose = false;
  bool set_twist = false;
  bool set_acceleration = false;
  GLOAM_MESSAGE(SetEntityState_Request, entity, state, set_pose, set_twist, set_acceleration)
};
struct SetEntityState_Response {
  Result result;
  GLOAM_CONSTANTS(uint8, INVALID_POSE = 101)
  GLOAM_MESSAGE(SetEntityState_Response, result)
};

struct GetEntityInfo_Request {
  std::string entity;
  GLOAM_MESSAGE(GetEntityInfo_Request, entity)
};
struct GetEntityInfo_Response {
  Result result;
  EntityInfo info;
  GLOAM_MESSAGE(GetEntityInfo_Response, result, info)
};

struct SetEntityInfo_Request {
  std::string entity;
  EntityInfo info;
  GLOAM_MESSAGE(SetEntityInfo_Request, entity, info)
};
struct SetEntityInfo_Response {
  Result result;
  GLOAM_MESSAGE(SetEntityInfo_Response, result)
};

struct GetEntityBounds_Request {
  std::string entity;
  GLOAM_MESSAGE(GetEntityBounds_Request, entity)
};
struct GetEntityBounds_Response {
  Result result;
  Bounds bounds;
  GLOAM_MESSAGE(GetEntityBounds_Response, result, bounds)
};

struct GetNamedPoses_Request {
  TagsFilter tags;
  GLOAM_MESSAGE(GetNamedPoses_Request, tags)
};
struct GetNamedPoses_Response {
  Result result;
  std::vector<NamedPose> poses;
  GLOAM_MESSAGE(GetNamedPoses_Response, result, poses)
};

struct GetNamedPoseBounds_Request {
  std::string name;
  GLOAM_MESSAGE(GetNamedPoseBounds_Request, name)
};
struct GetNamedPoseBounds_Response {
  Result result;
  Bounds bounds;
  GLOAM_MESSAGE(GetNamedPoseBounds_Response, result, bounds)
};

struct GetSpawnables_Request {
  std::vector<std::string> sources;
  GLOAM_MESSAGE(GetSpawnables_Request, sources)
};
struct GetSpawnables_Response {
  Result result;
  std::vector<Spawnable> spawnables;
  GLOAM_MESSAGE(GetSpawnables_Response, result, spawnables)
};

struct LoadWorld_Request {
  Resource world_resource;
  bool fail_on_unsupported_element = false;
  bool ignore_missing_or_unsupported_assets = false;
  GLOAM_MESSAGE(LoadWorld_Request, world_resource, fail_on_unsupported_element,
                ignore_missing_or_unsupported_assets)
};
struct LoadWorld_Response {
  Result result;
  WorldResource world;
  GLOAM_CONSTANTS(uint8, UNSUPPORTED_FORMAT = 101, NO_RESOURCE = 102, RESOURCE_PARSE_ERROR = 103,
                  MISSING_ASSETS = 104, UNSUPPORTED_ASSETS = 105, UNSUPPORTED_ELEMENTS = 106)
  GLOAM_MESSAGE(LoadWorld_Response, result, world)
};

struct UnloadWorld_Request {
  GLOAM_MESSAGE(UnloadWorld_Request)
};
struct UnloadWorld_Response {
  Result result;
  GLOAM_CONSTANTS(uint8, NO_WORLD_LOADED = 101)
  GLOAM_MESSAGE(UnloadWorld_Response, result)
};

struct GetCurrentWorld_Request {
  GLOAM_MESSAGE(GetCurrentWorld_Request)
};
struct GetCurrentWorld_Response {
  Result result;
  WorldResource world;
  GLOAM_CONSTANTS(uint8, NO_WORLD_LOADED = 101)
  GLOAM_MESSAGE(GetCurrentWorld_Response, result, world)
};

struct GetAvailableWorlds_Request {
  std::vector<std::string> additional_sources;
  TagsFilter filter;
  bool offline_only = false;
  bool continue_on_error = false;
  GLOAM_MESSAGE(GetAvailableWorlds_Request, additional_sources, filter, offline_only,
                continue_on_error)
};
struct GetAvailableWorlds_Response {
  Result result;
  std::vector<WorldResource> worlds;
  GLOAM_CONSTANTS(uint8, DEFAULT_SOURCES_FAILED = 101)
  GLOAM_MESSAGE(GetAvailableWorlds_Response, result, worlds)
};

}  // namespace srv

namespace action {

inline constexpr std::string_view kPackage = "simulation_interfaces/action";

struct SimulateSteps_Goal {
  uint64_t steps = 0;
  GLOAM_MESSAGE(SimulateSteps_Goal, steps)
};

struct SimulateSteps_Result {
  Result result;
  GLOAM_MESSAGE(SimulateSteps_Result, result)
};

struct SimulateSteps_Feedback {
  uint64_t completed_steps = 0;
  uint64_t remaining_steps = 0;
  GLOAM_MESSAGE(SimulateSteps_Feedback, completed_steps, remaining_steps)
};

struct SimulateSteps_SendGoal_Request {
  unique_identifier_msgs::UUID goal_id;
  SimulateSteps_Goal goal;
  GLOAM_MESSAGE(SimulateSteps_SendGoal_Request, goal_id, goal)
};

struct SimulateSteps_SendGoal_Response {
  bool accepted = false;
  builtin_interfaces::Time stamp;
  GLOAM_MESSAGE(SimulateSteps_SendGoal_Response, accepted, stamp)
};

struct SimulateSteps_GetResult_Request {
  unique_identifier_msgs::UUID goal_id;
  GLOAM_MESSAGE(SimulateSteps_GetResult_Request, goal_id)
};

struct SimulateSteps_GetResult_Response {
  int8_t status = 0;
  SimulateSteps_Result result;
  GLOAM_MESSAGE(SimulateSteps_GetResult_Response, status, result)
};

struct SimulateSteps_FeedbackMessage {
  unique_identifier_msgs::UUID goal_id;
  SimulateSteps_Feedback feedback;
  GLOAM_MESSAGE(SimulateSteps_FeedbackMessage, goal_id, feedback)
};

}  // namespace action
}  // namespace gloam::simulation_interfaces
