#pragma once
// Messages of ROS 2's package simulation_interfaces 2.1: how tools drive simulators. Services and
// the action are in simulation_services.h; shapes of its versions 1.x in simulation_interfaces_1.h.

#include "ros/messages/geometry_msgs.h"

namespace gloam::simulation_interfaces {

inline constexpr std::string_view kPackage = "simulation_interfaces/msg";

/// Each service has codes of its own above 100.
struct Result {
  uint8_t result = 1;
  std::string error_message;
  GLOAM_CONSTANTS(uint8, RESULT_FEATURE_UNSUPPORTED = 0, RESULT_OK = 1, RESULT_NOT_FOUND = 2,
                  RESULT_INCORRECT_STATE = 3, RESULT_OPERATION_FAILED = 4)
  GLOAM_MESSAGE(Result, result, error_message)
};

/// An address, or the text itself.
struct Resource {
  std::string uri;
  std::string resource_string;
  GLOAM_MESSAGE(Resource, uri, resource_string)
};

struct SimulationState {
  uint8_t state = 0;
  GLOAM_CONSTANTS(uint8, STATE_STOPPED = 0, STATE_PLAYING = 1, STATE_PAUSED = 2, STATE_QUITTING = 3,
                  STATE_NO_WORLD = 4, STATE_LOADING_WORLD = 5)
  GLOAM_MESSAGE(SimulationState, state)
};

/// In the frame of its header.
struct EntityState {
  std_msgs::Header header;
  geometry_msgs::Pose pose;
  geometry_msgs::Twist twist;
  geometry_msgs::Accel acceleration;
  GLOAM_MESSAGE(EntityState, header, pose, twist, acceleration)
};

struct EntityCategory {
  uint8_t category = 0;
  GLOAM_CONSTANTS(uint8, CATEGORY_OBJECT = 0, CATEGORY_ROBOT = 1, CATEGORY_HUMAN = 2,
                  CATEGORY_DYNAMIC_OBJECT = 4, CATEGORY_STATIC_OBJECT = 5)
  GLOAM_MESSAGE(EntityCategory, category)
};

struct EntityInfo {
  EntityCategory category;
  std::string description;
  std::vector<std::string> tags;
  GLOAM_MESSAGE(EntityInfo, category, description, tags)
};

struct TagsFilter {
  std::vector<std::string> tags;
  uint8_t filter_mode = 0;
  GLOAM_CONSTANTS(uint8, FILTER_MODE_ANY = 0, FILTER_MODE_ALL = 1)
  GLOAM_MESSAGE(TagsFilter, tags, filter_mode)
};

/// Points: a box's upper and lower corner; a hull's; a sphere's centre and {radius, -, -} [m].
struct Bounds {
  uint8_t type = 0;
  std::vector<geometry_msgs::Vector3> points;
  GLOAM_CONSTANTS(uint8, TYPE_EMPTY = 0, TYPE_BOX = 1, TYPE_CONVEX_HULL = 2, TYPE_SPHERE = 3)
  GLOAM_MESSAGE(Bounds, type, points)
};

/// Empty ones let all through; `filter` is a POSIX extended regular expression for names.
struct EntityFilters {
  std::string filter;
  std::vector<EntityCategory> categories;
  TagsFilter tags;
  Bounds bounds;
  GLOAM_MESSAGE(EntityFilters, filter, categories, tags, bounds)
};

struct NamedPose {
  std::string name;
  std::string description;
  std::vector<std::string> tags;
  geometry_msgs::Pose pose;
  GLOAM_MESSAGE(NamedPose, name, description, tags, pose)
};

struct Spawnable {
  Resource entity_resource;
  std::string description;
  Bounds spawn_bounds;
  GLOAM_MESSAGE(Spawnable, entity_resource, description, spawn_bounds)
};

/// One request of SpawnEntities.
struct SpawnEntity {
  std::string name;
  bool allow_renaming = false;
  Resource entity_resource;
  std::string entity_namespace;
  geometry_msgs::PoseStamped initial_pose;
  GLOAM_MESSAGE(SpawnEntity, name, allow_renaming, entity_resource, entity_namespace, initial_pose)
};

struct SpawnResult {
  Result result;
  std::string entity_name;
  GLOAM_CONSTANTS(uint8, NAME_NOT_UNIQUE = 101, NAME_INVALID = 102, UNSUPPORTED_FORMAT = 103,
                  NO_RESOURCE = 104, NAMESPACE_INVALID = 105, RESOURCE_PARSE_ERROR = 106,
                  MISSING_ASSETS = 107, UNSUPPORTED_ASSETS = 108, INVALID_POSE = 109)
  GLOAM_MESSAGE(SpawnResult, result, entity_name)
};

struct WorldResource {
  std::string name;
  Resource world_resource;
  std::string description;
  std::vector<std::string> tags;
  GLOAM_MESSAGE(WorldResource, name, world_resource, description, tags)
};

struct SimulatorFeatures {
  std::vector<uint16_t> features;
  std::vector<std::string> spawn_formats;
  std::string custom_info;
  GLOAM_CONSTANTS(uint8, SPAWNING = 0, DELETING = 1, NAMED_POSES = 2, POSE_BOUNDS = 3,
                  ENTITY_TAGS = 4, ENTITY_BOUNDS = 5, ENTITY_BOUNDS_BOX = 6,
                  ENTITY_BOUNDS_CONVEX = 7, ENTITY_CATEGORIES = 8, SPAWNING_RESOURCE_STRING = 9,
                  ENTITY_STATE_GETTING = 10, ENTITY_STATE_SETTING = 11, ENTITY_INFO_GETTING = 12,
                  ENTITY_INFO_SETTING = 13, SPAWNABLES = 14, SIMULATION_RESET = 20,
                  SIMULATION_RESET_TIME = 21, SIMULATION_RESET_STATE = 22,
                  SIMULATION_RESET_SPAWNED = 23, SIMULATION_STATE_GETTING = 24,
                  SIMULATION_STATE_SETTING = 25, SIMULATION_STATE_PAUSE = 26,
                  STEP_SIMULATION_SINGLE = 31, STEP_SIMULATION_MULTIPLE = 32,
                  STEP_SIMULATION_ACTION = 33, WORLD_LOADING = 40, WORLD_RESOURCE_STRING = 41,
                  WORLD_TAGS = 42, WORLD_UNLOADING = 43, WORLD_INFO_GETTING = 44,
                  AVAILABLE_WORLDS = 45, SPAWNING_ENTITIES = 50)
  GLOAM_MESSAGE(SimulatorFeatures, features, spawn_formats, custom_info)
};

}  // namespace gloam::simulation_interfaces
