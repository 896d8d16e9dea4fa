#pragma once
// Values of the Operator as messages of simulation_interfaces, and back.

#include <string>
#include <vector>

#include "bridge/operations/operator.h"
#include "ros/messages/simulation_interfaces.h"

namespace gloam::bridge {

simulation_interfaces::Result result_ok();
/// `code` 0 … 4 of Result, or a service's own.
simulation_interfaces::Result result_of(int code, std::string message);
/// The code by the Error's kind: see Operator. `wrong_state` is that of kUsage.
simulation_interfaces::Result result_of(
    const Status& status, int wrong_state = simulation_interfaces::Result::RESULT_INCORRECT_STATE);

geometry_msgs::Pose ros_pose_of(const Pose& pose);
Pose pose_from_ros(const geometry_msgs::Pose& pose);
Vec3 vec_from_ros(const geometry_msgs::Vector3& vector);
/// Simulation time, rounded to the nanosecond.
builtin_interfaces::Time ros_time_of(double time);

simulation_interfaces::EntityState state_message(const EntityState& state, double time);
simulation_interfaces::EntityInfo info_message(const Entity& entity);
uint8_t category_message(EntityKind kind);
/// Kind of a category; false = there is none.
bool kind_from_message(uint8_t category, EntityKind* kind);
simulation_interfaces::Bounds box_message(const Box& box);
/// A state of SimulationState; a simulation that has failed is paused.
uint8_t state_message(RunState state);
int spawn_code(SpawnFailure failure);

bool has_tags(const std::vector<std::string>& tags,
              const simulation_interfaces::TagsFilter& filter);
/// Entities that a filter lets through. Errors: kUnsupported, a kind of bounds; kInput, no regular
/// expression, bounds without points.
Result<std::vector<Entity>> filter_entities(const Operator& operations,
                                            const simulation_interfaces::EntityFilters& filters);

}  // namespace gloam::bridge
