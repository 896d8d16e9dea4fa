// Services of entities: lists, states, information, bounds, named poses.

#include <algorithm>

#include "bridge/operations/pose_math.h"
#include "bridge/ros2/services/simulation_services.h"
#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"
#include "ros/messages/simulation_interfaces.h"
#include "ros/messages/simulation_interfaces_1.h"

namespace gloam::bridge {
namespace {

namespace si = simulation_interfaces;
namespace srv = simulation_interfaces::srv;
namespace srv1 = simulation_interfaces_1::srv;
using EntityCode = si::Result;

// A filter that cannot be read fails; bounds of another kind are unsupported.
si::Result filter_result(const Error& error) {
  if (error.kind == ErrorKind::kInput)
    return result_of(EntityCode::RESULT_OPERATION_FAILED, error.to_string());
  return result_of(error);
}

srv::GetEntities_Response get_entities(const Operator& op, const si::EntityFilters& filters) {
  srv::GetEntities_Response response{.result = result_ok()};
  const Result<std::vector<Entity>> entities = filter_entities(op, filters);
  if (!entities.ok()) {
    response.result = filter_result(entities.error());
    return response;
  }
  for (const Entity& entity : *entities) response.entities.push_back(entity.name);
  return response;
}

srv::GetEntitiesStates_Response get_states(Operator& op, const si::EntityFilters& filters) {
  srv::GetEntitiesStates_Response response{.result = result_ok()};
  const Result<std::vector<Entity>> entities = filter_entities(op, filters);
  if (!entities.ok()) {
    response.result = filter_result(entities.error());
    return response;
  }
  const Result<std::vector<EntityState>> states = op.entity_states(*entities);
  if (!states.ok()) {
    response.result = result_of(states.error());
    return response;
  }
  const double time = op.simulation().latest().time();
  for (size_t i = 0; i < states->size(); ++i) {
    response.entities.push_back((*entities)[i].name);
    response.states.push_back(state_message((*states)[i], time));
  }
  return response;
}

srv::GetEntityState_Response get_state(Operator& op, const std::string& name) {
  srv::GetEntityState_Response response{.result = result_ok()};
  const Result<EntityState> state = op.entity_state(name);
  if (!state.ok()) {
    response.result = result_of(state.error());
    return response;
  }
  response.state = state_message(*state, op.simulation().latest().time());
  return response;
}

bool is_zero(const geometry_msgs::Twist& twist) { return twist == geometry_msgs::Twist{}; }

si::Result set_state(Operator& op, const srv::SetEntityState_Request& request) {
  using Response = srv::SetEntityState_Response;
  const Result<Entity> entity = op.find_entity(request.entity);
  if (!entity.ok()) return result_of(entity.error());
  const std::string& frame = request.state.header.frame_id;
  StateChange change;
  if (request.set_pose) {
    Pose pose = pose_from_ros(request.state.pose);
    if (!is_finite(pose.p) || !normalize(&pose.q))
      return result_of(Response::INVALID_POSE,
                       "the pose is not finite, or its orientation is not a unit quaternion");
    change.X_WE = pose;
  }
  if (request.set_twist) {
    change.velocity = vec_from_ros(request.state.twist.linear);
    change.angular_velocity = vec_from_ros(request.state.twist.angular);
  }
  if (!frame.empty() && frame != "world") {
    const Result<Entity> base = op.find_entity(frame);
    if (!base.ok())
      return result_of(EntityCode::RESULT_OPERATION_FAILED, "there is no frame '" + frame + "'");
    const Result<EntityState> at = op.entity_state(frame);
    if (!at.ok()) return result_of(at.error());
    if (change.X_WE) change.X_WE = product(at->X_WE, *change.X_WE);
    if (change.velocity) change.velocity = rotate(at->X_WE.q, *change.velocity);
    if (change.angular_velocity)
      change.angular_velocity = rotate(at->X_WE.q, *change.angular_velocity);
  }
  // Fixed entities keep a twist of zero.
  const bool has_twist = entity->joint >= 0;
  if (!has_twist && request.set_twist && is_zero(request.state.twist)) {
    change.velocity.reset();
    change.angular_velocity.reset();
    if (!change.X_WE) return result_ok();
  }
  const Status status = op.set_entity_state(request.entity, change);
  if (status.ok()) return result_ok();
  return result_of(EntityCode::RESULT_OPERATION_FAILED, status.error().to_string());
}

// 1.x has no flags: what does not move takes the pose alone.
srv::SetEntityState_Request with_flags(const Operator& op,
                                       const srv1::SetEntityState_Request& old) {
  srv::SetEntityState_Request request;
  request.entity = old.entity;
  request.state = old.state;
  request.set_pose = true;
  const Result<Entity> entity = op.find_entity(old.entity);
  request.set_twist = (entity.ok() && entity->joint >= 0) || !is_zero(old.state.twist);
  return request;
}

srv::GetEntityInfo_Response get_info(const Operator& op, const std::string& name) {
  srv::GetEntityInfo_Response response{.result = result_ok()};
  const Result<Entity> entity = op.find_entity(name);
  if (!entity.ok()) {
    response.result = result_of(entity.error());
    return response;
  }
  response.info = info_message(*entity);
  return response;
}

si::Result set_info(Operator& op, const srv::SetEntityInfo_Request& request) {
  const Result<Entity> entity = op.find_entity(request.entity);
  if (!entity.ok()) return result_of(entity.error());
  EntityKind kind;
  if (!kind_from_message(request.info.category.category, &kind))
    return result_of(EntityCode::RESULT_OPERATION_FAILED, "the category does not exist");
  const Status status =
      op.set_info(request.entity, request.info.description, request.info.tags, kind);
  if (status.ok()) return result_ok();
  return result_of(EntityCode::RESULT_OPERATION_FAILED, status.error().to_string());
}

srv::GetEntityBounds_Response get_bounds(const Operator& op, const std::string& name) {
  srv::GetEntityBounds_Response response{.result = result_ok()};
  const Result<Box> box = op.entity_bounds(name, BoxFrame::kEntity);
  if (!box.ok()) {
    response.result = result_of(box.error());
    return response;
  }
  response.bounds = box_message(*box);
  return response;
}

srv::GetNamedPoses_Response get_named_poses(const Operator& op, const si::TagsFilter& tags) {
  srv::GetNamedPoses_Response response{.result = result_ok()};
  for (const NamedPose& pose : op.named_poses())
    if (has_tags(pose.tags, tags))
      response.poses.push_back({pose.name, pose.description, pose.tags, ros_pose_of(pose.X_WP)});
  return response;
}

srv::GetNamedPoseBounds_Response get_pose_bounds(const Operator& op, const std::string& name) {
  srv::GetNamedPoseBounds_Response response{.result = result_ok()};
  const std::vector<NamedPose> poses = op.named_poses();
  const auto pose = std::ranges::find(poses, name, &NamedPose::name);
  if (pose == poses.end()) {
    response.result =
        result_of(EntityCode::RESULT_NOT_FOUND, "there is no named pose '" + name + "'");
  } else if (pose->radius > 0) {
    response.bounds.type = si::Bounds::TYPE_SPHERE;
    response.bounds.points = {{pose->X_WP.p.x, pose->X_WP.p.y, pose->X_WP.p.z},
                              {pose->radius, 0, 0}};
  } else {
    response.bounds = box_message(pose->box);
  }
  return response;
}

}  // namespace

void add_entity_services(ServiceTable* table) {
  Operator* const op = &table->operations;
  const std::string& ns = table->ns;
  const auto add = [table](Ros2Service service) { table->list.push_back(std::move(service)); };
  add(make_service<srv::GetEntities_Request, srv::GetEntities_Response>(
      ns + "/get_entities",
      [op](const srv::GetEntities_Request& r) { return get_entities(*op, r.filters); }));
  add(make_service<srv::GetEntitiesStates_Request, srv::GetEntitiesStates_Response>(
      ns + "/get_entities_states",
      [op](const srv::GetEntitiesStates_Request& r) { return get_states(*op, r.filters); }));
  add(make_service<srv::GetEntityState_Request, srv::GetEntityState_Response>(
      ns + "/get_entity_state",
      [op](const srv::GetEntityState_Request& r) { return get_state(*op, r.entity); }));
  if (table->interfaces == 1) {
    add(make_service<srv1::SetEntityState_Request, srv::SetEntityState_Response>(
        ns + "/set_entity_state", [op](const srv1::SetEntityState_Request& r) {
          return srv::SetEntityState_Response{set_state(*op, with_flags(*op, r))};
        }));
  } else {
    add(make_service<srv::SetEntityState_Request, srv::SetEntityState_Response>(
        ns + "/set_entity_state", [op](const srv::SetEntityState_Request& r) {
          return srv::SetEntityState_Response{set_state(*op, r)};
        }));
  }
  add(make_service<srv::GetEntityInfo_Request, srv::GetEntityInfo_Response>(
      ns + "/get_entity_info",
      [op](const srv::GetEntityInfo_Request& r) { return get_info(*op, r.entity); }));
  add(make_service<srv::SetEntityInfo_Request, srv::SetEntityInfo_Response>(
      ns + "/set_entity_info", [op](const srv::SetEntityInfo_Request& r) {
        return srv::SetEntityInfo_Response{set_info(*op, r)};
      }));
  add(make_service<srv::GetEntityBounds_Request, srv::GetEntityBounds_Response>(
      ns + "/get_entity_bounds",
      [op](const srv::GetEntityBounds_Request& r) { return get_bounds(*op, r.entity); }));
  add(make_service<srv::GetNamedPoses_Request, srv::GetNamedPoses_Response>(
      ns + "/get_named_poses",
      [op](const srv::GetNamedPoses_Request& r) { return get_named_poses(*op, r.tags); }));
  add(make_service<srv::GetNamedPoseBounds_Request, srv::GetNamedPoseBounds_Response>(
      ns + "/get_named_pose_bounds",
      [op](const srv::GetNamedPoseBounds_Request& r) { return get_pose_bounds(*op, r.name); }));
}

}  // namespace gloam::bridge
